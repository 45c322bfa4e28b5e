#pragma once
// The scope's requests: what signals there are, and windows of them, every sample or the extremes of each k cycles. Answered in steps of
// bounded work: an answer may come some steps later than those to other requests. README.md has the table. Service side, one thread.

#include <cstddef>
#include <deque>
#include <list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/socket/json_fields.hpp"
#include "runtime/recording/signal_rows.hpp"
#include "runtime/recording/thinned_read.hpp"

namespace taktwerk::hmi {

class ScopeRequests {
public:
    static constexpr std::size_t most_signals = 64;        ///< of a request
    static constexpr std::size_t most_numbers = 200'000;   ///< of an answer
    static constexpr std::size_t most_reads = 4;           ///< of a connection, that wait
    static constexpr std::size_t cells_per_step = 50'000;  ///< values looked at: some hundred microseconds

    /// `live` outlives this; nullptr: the machine keeps no signals, and every request is refused.
    explicit ScopeRequests(const runtime::SignalRows* live) : live_(live) {}

    [[nodiscard]] static std::span<const std::string_view> words();
    [[nodiscard]] static bool knows(std::string_view cmd);
    /// `id` as JSON. Errors: request..., scope.unknown_signal, scope.busy, scope.none; they are answers at once.
    [[nodiscard]] Result<void> handle(ConnectionId connection, const std::string& id, std::string_view cmd, JsonFields& fields);
    void forget(ConnectionId connection);
    void step();

    struct Answer {
        ConnectionId connection = 0;
        std::string text;  ///< the line
    };
    [[nodiscard]] std::optional<Answer> next_answer();

private:
    struct Read {
        ConnectionId connection = 0;
        std::string id;
        const runtime::SignalRows* rows = nullptr;
        runtime::ThinnedRead read;
        std::string data;         // of the signals that are text already
        std::size_t encoded = 0;  // so many
    };
    [[nodiscard]] Result<void> begin_read(ConnectionId connection, const std::string& id, JsonFields& fields,
                                          const runtime::SignalRows& rows);
    /// True: its answer is out.
    bool go_on(Read& read, std::size_t& cells);

    const runtime::SignalRows* live_;
    std::list<Read> reads_;
    std::deque<Answer> answers_;
};

/// {"cycle_ns":...,"first":...,"last":...,"depth":...,"signals":[...]}
[[nodiscard]] std::string signals_json(const runtime::SignalRows& rows);

}  // namespace taktwerk::hmi
