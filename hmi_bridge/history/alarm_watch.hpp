#pragma once
// Looks at the list of alarms again and again and says what changed in it, as rows of the history. Alarms that came and went between two looks are
// among them (Snapshot::passed_alarms). One thread, not real-time.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "hmi_bridge/history/alarm_row.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

class AlarmWatch {
public:
    using Describe = std::function<runtime::AlarmText(const AlarmFact&)>;
    /// So long after it was raised its numbers still change its words: a drive tells the detail of an alarm later.
    static constexpr Duration settles = std::chrono::seconds{2};
    /// A note or warning that comes again so soon is the same row, counted: what flutters must not push out what stopped the machine.
    static constexpr Duration flutters = std::chrono::seconds{10};
    /// Of those that left the list, for a recording that is complete only then.
    static constexpr std::size_t remembered = 64;

    explicit AlarmWatch(Describe describe) : describe_(std::move(describe)) {}

    /// What was recorded around an alarm that stops something; empty: nothing, or not yet.
    using RecordingOf = std::function<std::string(const AlarmFact&, Instant since)>;
    /// Asked by look() for `settles` after each alarm. Before the first look.
    void set_recordings(RecordingOf recording_of) { recording_of_ = std::move(recording_of); }

    struct Change {
        std::uint64_t key = 0;  ///< of the alarm in this run; a later change of it has the same
        AlarmRow row;           ///< as it is now; without an id
    };
    /// `utime`: us since 1970 at `now`.
    [[nodiscard]] std::vector<Change> look(const runtime::Snapshot& snapshot, Instant now, std::int64_t utime);
    /// What was recorded around an alarm of the list, or one of those that left it last; a change of the next look.
    void name_recording(const AlarmFact& fact, Instant since, std::string recording);
    /// Alarms that passed unseen, because more came between two looks than the machine remembers. A row says how many (alarm_log_full), one for
    /// those that follow each other within `flutters`.
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

private:
    struct Known {
        AlarmFact fact;
        Instant since{};
        Change told;
        Instant left{};            // when it was gone
        std::uint32_t before = 0;  // times of its row that are over
        bool listed = true, changed = true;
    };
    Known* fluttering(const AlarmFact& fact, Instant since, Reaction reaction);
    Known& known(const AlarmFact& fact, Instant since, Reaction reaction);
    void describe(Known& alarm) const;
    /// The row of those that nobody saw.
    [[nodiscard]] const Change& unseen(std::uint64_t more);
    /// True: it has just got one.
    [[nodiscard]] bool named(Known& alarm) const;
    [[nodiscard]] std::int64_t utime_of(Instant at) const noexcept;

    Describe describe_;
    RecordingOf recording_of_;
    std::vector<Known> known_;
    std::deque<Known> left_;
    std::vector<Change> named_late_;
    std::optional<Known> unseen_;
    std::uint64_t next_key_ = 1, next_passed_ = 0, missed_ = 0;
    Instant now_{};
    std::int64_t utime_ = 0;
};

}  // namespace taktwerk::hmi
