#pragma once
// The scope's requests: what signals there are, windows of them (every sample or the extremes of each k cycles), triggers, and the same of
// recordings that were kept around alarms. Answered in steps of bounded work: an answer may come some steps later than those to other
// requests. README.md has the table. Service side, one thread.

#include <cstddef>
#include <deque>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/machine_link.hpp"
#include "hmi_bridge/socket/json_fields.hpp"
#include "hmi_bridge/socket/scope_trigger.hpp"
#include "runtime/flight/flight_recorder.hpp"
#include "runtime/recording/signal_rows.hpp"
#include "runtime/recording/thinned_read.hpp"

namespace taktwerk::runtime {
class RunMemory;
}

namespace taktwerk::hmi {

class ScopeRequests {
public:
    static constexpr std::size_t most_signals = 64;                 ///< of a request
    static constexpr std::size_t most_numbers = 200'000;            ///< of an answer
    static constexpr std::size_t most_reads = 4;                    ///< of a connection, that wait
    static constexpr std::size_t cells_per_step = 50'000;           ///< values looked at: some hundred microseconds
    static constexpr Duration patience = std::chrono::seconds{10};  ///< for a disk that has a recording

    /// `machine` outlives this.
    explicit ScopeRequests(const MachineLink& machine) : machine_(machine), trigger_(machine) {}
    /// Without one nothing is kept. Outlives this.
    void set_recorder(runtime::FlightRecorder* recorder) noexcept { recorder_ = recorder; }
    /// Without one no run is kept. Outlives this.
    void set_run_memory(runtime::RunMemory* memory) noexcept { run_memory_ = memory; }

    [[nodiscard]] static std::span<const std::string_view> words();
    [[nodiscard]] static bool knows(std::string_view cmd);
    /// `id` as JSON. Errors are answers at once: request..., scope..., recording...
    [[nodiscard]] Result<void> handle(ConnectionId connection, const std::string& id, std::string_view cmd, JsonFields& fields,
                                      Instant now);
    void forget(ConnectionId connection);
    /// `snapshot`: the newest, nullptr before the first.
    void step(const runtime::Snapshot* snapshot, Instant now);

    struct Answer {
        ConnectionId connection = 0;
        std::string id;
        std::string text;              ///< the line
        std::optional<Error> error{};  ///< instead of it
    };
    [[nodiscard]] std::optional<Answer> next_answer();

private:
    /// What a reading asks for, before it is known what is there.
    struct Asked {
        std::vector<std::string> signals;  ///< none: the list of signals is asked for
        std::optional<std::uint64_t> from, to, points;
    };
    struct Loading {  // a recording, on its way from the disk
        ConnectionId connection = 0;
        std::string id, recording;
        Asked asked;
        Instant since{};
        std::optional<std::uint64_t> part{};  // its file from this byte on, instead of its signals
    };
    struct Read {
        ConnectionId connection = 0;
        std::string id;
        const runtime::SignalRows* rows = nullptr;
        runtime::FlightRecorder::Rows kept;  // whose they are, where they are a recording's
        runtime::ThinnedRead read;
        std::string data;         // of the signals that are text already
        std::size_t encoded = 0;  // so many
    };
    [[nodiscard]] static Asked read_asked(JsonFields& fields);
    [[nodiscard]] Result<void> handle_recordings(ConnectionId connection, const std::string& id, std::string_view cmd, JsonFields& fields,
                                                 Instant now);
    [[nodiscard]] Result<void> handle_replay(ConnectionId connection, const std::string& id, std::string_view cmd, JsonFields& fields,
                                             Instant now);
    [[nodiscard]] Result<void> may_begin(ConnectionId connection) const;
    [[nodiscard]] Result<void> begin_read(ConnectionId connection, const std::string& id, const Asked& asked,
                                          const runtime::SignalRows& rows, runtime::FlightRecorder::Rows kept);
    void look_for_loaded(Instant now);
    /// True: there is an answer, or an error.
    bool give_part(const Loading& loading, Instant now);
    /// True: its answer is out.
    bool go_on(Read& read, std::size_t& cells);
    void say(ConnectionId connection, const std::string& id, std::string_view key, std::string_view value);

    const MachineLink& machine_;
    runtime::FlightRecorder* recorder_ = nullptr;
    runtime::RunMemory* run_memory_ = nullptr;
    ScopeTrigger trigger_;
    std::list<Loading> loading_;
    std::list<Read> reads_;
    std::deque<Answer> answers_;
};

/// {"cycle_ns":...,"first":...,"last":...,"depth":...,"signals":[...]}
[[nodiscard]] std::string signals_json(const runtime::SignalRows& rows);

}  // namespace taktwerk::hmi
