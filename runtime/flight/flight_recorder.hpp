#pragma once
// Keeps the seconds around each alarm that stops an axis or the machine, from the memory of the scope.
//
//     auto recorder = FlightRecorder::open(machine, folder, epoch);
//     service side: look(snapshot) again and again;   a thread that may wait for a disk: work() again and again, finish() last
//
// Alarms that come within half a second share a recording, named by the first: one trouble has many of them. Each has all of its
// seconds in it. What comes later has one of its own, overlapping or not.

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/alarm.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/new_alarms.hpp"
#include "runtime/scope_file/scope_file.hpp"

namespace taktwerk::runtime {

class FlightRecorder {
public:
    static constexpr Duration together = std::chrono::milliseconds{500};  ///< alarms that share a recording
    static constexpr std::size_t most_waiting = 16;  ///< recordings that are not written yet; what comes then joins the last
    static constexpr std::size_t most_loaded = 2;    ///< in memory, for who looks at them
    static constexpr std::size_t part_bytes = 262'144, most_parts = 16;  ///< of files, for who copies them

    /// Of the machine's `recording`; `folder` is made, and what a killed process left unfinished in it goes. `epoch`: calendar time at
    /// machine time 0. `machine` outlives it. Errors: recording.directory.
    [[nodiscard]] static Result<std::unique_ptr<FlightRecorder>> open(const Machine& machine, std::string folder, Duration epoch);

    // --- service side: nothing in it waits -----------------------------------------------------------------------------------------
    void look(const Snapshot& snapshot);
    /// The recording that shows this alarm, be it still to be written; empty: none.
    [[nodiscard]] std::string recording_of(const AlarmFact& fact, Instant since) const;
    struct Kept {
        std::string name;                                 ///< of the file, without its ending
        std::string alarm, source;                        ///< "following_error", "axis x": the first one
        std::int64_t utime = 0;                           ///< of that alarm, us since 1970
        std::uint64_t from = 0, to = 0, alarm_cycle = 0;  ///< cycles [from, to)
        std::uint64_t bytes = 0;
        bool complete = false;  ///< false: its last seconds are still to come, or it was cut
    };
    /// Newest first.
    [[nodiscard]] std::vector<Kept> kept() const;
    using Rows = std::shared_ptr<const KeptRows>;
    /// Has it loaded beside; ask again until there is something. Errors: recording.unknown, recording.not_yet (it is still being recorded), those of
    /// read_scope_file().
    [[nodiscard]] std::optional<Result<Rows>> rows(const std::string& name);

    struct Part {
        std::uint64_t size = 0;  ///< of the whole file
        std::string bytes;       ///< part_bytes of it at most
    };
    /// The file itself from a byte on, for who copies it. Read beside, as rows(). Errors: recording.unknown, recording.not_yet, recording.read.
    [[nodiscard]] std::optional<Result<Part>> part(const std::string& name, std::uint64_t from);

    // --- a thread that may wait ------------------------------------------------------------------------------------------------------
    struct File {
        std::string path;  ///< empty: nothing was due
        Duration covered{};
        std::vector<ScopeHead::Alarm> alarms;
        std::uint64_t bytes = 0;
    };
    /// The next recording that is due, and what was asked for. Errors recording.write, recording.too_late: that recording is lost, later
    /// ones are tried.
    [[nodiscard]] Result<File> work();
    /// After the last cycle: what has not been written yet, as far as it came, one a call; an empty path when there is no more.
    [[nodiscard]] Result<File> finish();

    [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

private:
    struct Shown {
        AlarmFact fact;
        Instant since{};
    };
    struct Waiting {
        Kept kept;
        std::vector<ScopeHead::Alarm> alarms;
        bool being_written = false;
    };
    struct Loaded {
        std::string name;
        std::optional<Result<Rows>> rows;  // nullopt: asked for
    };
    struct AskedPart {
        std::string name;
        std::uint64_t from = 0;
        std::optional<Result<Part>> part;  // nullopt: asked for
    };
    FlightRecorder(const Machine& machine, std::string folder, Duration epoch);
    void find_kept();
    [[nodiscard]] std::optional<Error> why_not(const std::string& name) const;  // under the mutex
    [[nodiscard]] bool notice(const AlarmFact& fact, Reaction reaction, Instant since);
    [[nodiscard]] std::string name_for(Instant since, std::string_view alarm) const;
    [[nodiscard]] Result<File> write_next(bool all);
    [[nodiscard]] Result<File> write(Waiting& waiting) const;
    void load_next();
    void read_next_part();

    const Machine& machine_;
    const RecordingConfig& config_;
    std::string folder_;
    Duration epoch_;
    NewAlarms alarms_;  // service side

    mutable std::mutex mutex_;
    std::deque<Waiting> waiting_;
    std::vector<Kept> kept_;                              // oldest first
    std::deque<std::pair<Shown, std::string>> by_alarm_;  // the newest
    std::deque<Loaded> loaded_;
    std::deque<AskedPart> parts_;
};

}  // namespace taktwerk::runtime
