#pragma once
// Where people's lines come in. The door reads every connection as soon as something has come, raises what must act at once (stop, end
// of the run, a jog let go, a client lost) as levels of the machine, and hands all other lines to the service side through bounded
// queues: what a client sends too much of is refused to that client. Nobody's answers, floods or silence hold up a stop, and neither
// does the service thread.
//
//   thread of the door    wait(), step()          in real time a thread of its own (apps/machine/run.cpp); in tests whoever steps the bridge
//   service thread        pass_on(), answer()

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"
#include "hmi_bridge/gateway/deed_log.hpp"
#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/machine_link.hpp"
#include "hmi_bridge/socket/socket_server.hpp"
#include "hmi_bridge/socket/urgent_line.hpp"

namespace taktwerk::hmi {

class Door final : private LineHandler {
public:
    static constexpr std::size_t lines_waiting = 1024;                       ///< of one connection
    static constexpr std::size_t bytes_waiting = 512 * 1024;                 ///< likewise
    static constexpr std::size_t lines_per_step = 32;                        ///< of one connection, handed on
    static constexpr std::size_t bytes_per_step = 64 * 1024;                 ///< likewise
    static constexpr Duration patience = std::chrono::milliseconds{500};     ///< for the cycle to take a level
    static constexpr Duration unseen = std::chrono::milliseconds{100};       ///< a door that did not look for longer knows no line's age
    static constexpr Duration after_close = std::chrono::milliseconds{100};  ///< so late a line of a closed client is still carried out
    static constexpr Duration jog_hold = std::chrono::seconds{1};            ///< without a renewal nobody holds any more

    /// `machine` outlives the door; of it only what any thread may call is used. `log`: any thread.
    Door(MachineLink& machine, std::unique_ptr<SocketServer> server, std::function<void(std::string_view)> log);

    // --- thread of the door -------------------------------------------------------------------------------------------------------
    /// Further work of this thread, e.g. another source of commands.
    std::function<void(Instant)> also;
    void step(Instant now);
    /// Part of step(): what the service side has answered goes out.
    void send_answers();
    /// Until something comes, an answer is to be sent, or `most` has passed.
    void wait(Duration most) { server_->wait(pending_.empty() ? most : std::min<Duration>(most, std::chrono::milliseconds{1})); }

    // --- service thread -----------------------------------------------------------------------------------------------------------
    /// What has come, to the handler; of each connection at most its share.
    void pass_on(RequestHandler& handler, Instant now);
    /// A line for a client. `refused`: the id of the command that it refuses; empty: none.
    void answer(ConnectionId connection, std::string text, std::string refused = {});

    [[nodiscard]] const std::string& path() const noexcept { return server_->path(); }

private:
    struct Waiting {
        std::string text;
        Arrival arrival;
    };
    struct Queue {
        Peer peer;
        bool opened = false;  ///< told to the handler
        bool closed = false;
        std::deque<Waiting> lines;
        std::size_t bytes = 0;
    };
    struct Answer {
        ConnectionId connection = 0;
        std::string text, refused;
    };
    struct Pending {  // a level, until the cycle has taken it
        ConnectionId connection = 0;
        std::string id;
        UrgentLine::Kind kind{};
        runtime::StopLevels::Ticket ticket;
        Instant since{};
    };
    struct Hold {
        ConnectionId connection = 0;
        std::string press;  // id of the press
        Instant renewed{};
    };

    void on_open(ConnectionId connection, const Peer& peer) override;
    void on_line(ConnectionId connection, std::string_view line, Instant now) override;
    void on_close(ConnectionId connection) override;
    [[nodiscard]] bool may_go(ConnectionId connection) const override { return holds_.empty() || !holds(connection); }
    [[nodiscard]] bool holds(ConnectionId connection) const;
    /// True when a level was raised for it.
    bool let_go(ConnectionId connection, std::uint16_t axis);
    /// To the service side, or refused: in reserve, or too much of it.
    void hand_on(ConnectionId connection, std::string_view line, const Arrival& arrival);
    void settle_pending(Instant now);

    MachineLink& machine_;
    std::unique_ptr<SocketServer> server_;
    DeedLog deeds_;

    // door
    Instant now_{}, looked_{}, read_at_{};
    std::vector<Pending> pending_;
    std::multimap<std::uint16_t, Hold> holds_;  // by axis
    struct Guest {
        bool in_reserve = false;
        std::string name;
    };
    std::map<ConnectionId, Guest> guests_;

    // both sides
    std::mutex mutex_;
    std::map<ConnectionId, Queue> queues_;
    std::deque<Answer> answers_;
    std::size_t answer_bytes_ = 0;
};

}  // namespace taktwerk::hmi
