#pragma once
// The history of one machine's alarms, kept in a file over restarts.
//
//   service side        look(), ask(), next_answer(): wait for nothing, allocate
//   a thread that may   work() again and again, finish() last: they wait for the disk (docs/stopping.md). In virtual time the one thread does both.
//   wait
//
// The machine never depends on it. A disk that is full, read-only or gone is told once; what comes meanwhile waits here, bounded, and is tried again. The file is made
// with the first alarm.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/history/alarm_row.hpp"
#include "hmi_bridge/history/alarm_watch.hpp"
#include "hmi_bridge/history/history_store.hpp"

namespace taktwerk::hmi {

class AlarmHistory {
public:
    static constexpr std::size_t most_waiting = 4096;  ///< changed alarms that the file has not taken; further new ones are dropped
    static constexpr std::size_t most_questions = 16;  ///< under way at once
    static constexpr Duration together = std::chrono::milliseconds{200};  ///< from one write to the next, at least: a burst costs few waits
    static constexpr Duration again = std::chrono::seconds{10};           ///< after a failure
    static constexpr Duration patience = std::chrono::seconds{5};         ///< of a question

    /// `rows`: of the file, at least 1. `describe`: called by look() alone. `log`: any thread; one line for what a person should know.
    AlarmHistory(std::string path, std::int64_t rows, AlarmWatch::Describe describe, std::function<void(std::string_view)> log);

    // --- service side -------------------------------------------------------------------------------------------------------------
    /// `utime`: us since 1970 at `now`.
    void look(const runtime::Snapshot& snapshot, Instant now, std::int64_t utime);
    /// What was recorded around an alarm that look() has seen.
    void name_recording(const AlarmFact& fact, Instant since, std::string recording) {
        watch_.name_recording(fact, since, std::move(recording));
    }
    /// Asked by look(), for the name of the recording around each alarm. Before the first look.
    void set_recordings(AlarmWatch::RecordingOf recording_of) { watch_.set_recordings(std::move(recording_of)); }
    struct Answer {
        std::uint64_t tag = 0;
        std::string id;
        Result<HistoryPage> page;
    };
    /// `tag` and `id` come back with the answer, of which there is exactly one.
    void ask(std::uint64_t tag, std::string id, HistoryQuery query, Instant now);
    [[nodiscard]] std::optional<Answer> next_answer(Instant now);

    // --- the thread that may wait -------------------------------------------------------------------------------------------------
    /// Errors are told by `log` and tried again.
    void work(Instant now);
    /// Once, after the last look.
    void finish(Instant now);

    [[nodiscard]] const std::string& path() const noexcept { return path_; }

private:
    struct Asked {
        std::uint64_t tag = 0;
        std::string id;
        Instant since{};
    };
    struct Question {
        std::uint64_t number = 0;
        HistoryQuery query;
    };
    struct Answered {
        std::uint64_t number = 0;
        Result<HistoryPage> page;
    };
    using Waiting = std::map<std::uint64_t, AlarmRow>;  // by the watch's key: as each alarm is now

    /// False: it did not work, and that has been told.
    bool open();
    bool write(Instant now);
    void fail(const Error& error, Instant now);
    [[nodiscard]] Result<HistoryPage> read(const HistoryQuery& query, Instant now);

    const std::string path_;
    const std::int64_t rows_;
    std::function<void(std::string_view)> log_;

    // service side
    AlarmWatch watch_;
    std::map<std::uint64_t, Asked> asked_;  // by the question's number
    std::uint64_t next_question_ = 1, said_missed_ = 0;
    std::deque<Answer> refused_;

    std::mutex mutex_;  // held by both, and for no disk
    Waiting waiting_;
    std::uint64_t dropped_ = 0, last_dropped_ = 0;
    std::deque<Question> questions_;
    std::deque<Answered> answered_;

    // the thread that may wait
    std::unique_ptr<HistoryStore> store_;
    std::int64_t run_ = 0;
    std::optional<Error> trouble_;  // told
    std::uint64_t said_dropped_ = 0;
    Instant next_write_{}, next_try_{}, now_{};
};

}  // namespace taktwerk::hmi
