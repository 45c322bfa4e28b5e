#pragma once
// The one gate for commands of people, wherever they come from (local socket, LCM): validates completely, resolves names,
// keeps order per client, hands on to the machine, brings the answers back with words. Nothing reaches the cycle but through it.
//
//   const ClientId id = gateway.open(Source::socket, "pid 812", Rights::commissioning);
//   gateway.handle({.client = id, .sequence = 1, .kind = CommandKind::home, .target = "x"}, now);
//   gateway.step(now);                                   // each service step: answers and time-outs
//   while (auto reply = gateway.next_reply()) ...        // exactly one for each handled command, sooner or later
//
// Stop, shutdown and a jog let go are levels of the machine: no age, no queue and no sequence refuses them (machine_link.hpp).
//
// Other rules: a client's sequence increases; the same command with a sequence of its last 16 is answered again, not executed again.
// One client jogs an axis at a time, and while it does nobody else moves or homes that axis; who jogs a group jogs all of its axes. A client that closes while jogging stops its
// axis, whatever moves it; one that just vanishes stops it by letting the lease run out in the cycle; outputs that it has set become safe, points
// that it has forced are their own again. What
// clients do is told to the log by who they are. Over LCM nobody is known and nobody is missed: nothing that ends the run, or that would stand
// when its sender has gone, is taken from there. One thread, not real-time.

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/command_words.hpp"
#include "hmi_bridge/gateway/deed_log.hpp"
#include "hmi_bridge/gateway/group_jog_request.hpp"
#include "hmi_bridge/gateway/hands.hpp"
#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/machine_link.hpp"

namespace taktwerk::hmi {

using ClientId = std::uint32_t;  ///< 0 is nobody

enum class Source : std::uint8_t { socket, lcm, modbus };

/// What a client may claim to be.
enum class Rights : std::uint8_t { operating, commissioning };

/// A command as every source hands it over: names, not indices (a view may be older than the configuration).
struct CommandRequest {
    ClientId client = 0;
    std::uint64_t sequence = 0;  ///< >= 1
    CommandKind kind = CommandKind::none;
    std::string target;          ///< name; "all" (or empty for stop and reset) where the table allows it
    bool press = false;          ///< jog, group_jog, measure: the first one; renewals have false
    bool output = false;         ///< force, unforce: `target` is an output, not an input
    bool commissioning = false;  ///< commands in the name of commissioning instead of the operator panel
    runtime::Mode mode = runtime::Mode::manual;
    double value = 0, value2 = 0;
    axes::MeasureOrder measure;                    ///< of a measure
    GroupJogRequest group_jog;                     ///< of a group_jog
    Duration valid_for = std::chrono::seconds{1};  ///< 1 ms .. 10 s; jog: up to 500 ms
    Duration age{};                                ///< since the client gave it, by the common wall clock; negative: the clocks disagree
    Arrival arrival;                               ///< how it came here; Arrival::at the epoch: just now

    /// The same command (when it was sent does not matter).
    [[nodiscard]] bool same_as(const CommandRequest& other) const noexcept;
};

/// That of the word; of a point what the request says.
[[nodiscard]] TargetKind target_kind(const CommandWord& word, const CommandRequest& request) noexcept;

struct CommandReply {
    ClientId client = 0;
    Source source = Source::socket;
    std::uint64_t sequence = 0;
    CommandKind kind = CommandKind::none;
    runtime::Answer answer = runtime::Answer::accepted;
    axes::ErrorId axis_error = axes::ErrorId::none;
    Error error;         ///< empty code when accepted
    std::string note{};  ///< accepted, but not quite as asked for: "limited to 20 mm/s by setup mode"
    [[nodiscard]] bool accepted() const noexcept { return answer == runtime::Answer::accepted; }
};

class Gateway {
public:
    static constexpr std::size_t max_clients = 48;  ///< of all sources together
    static constexpr std::size_t remembered = 16;   ///< commands per client
    static constexpr Duration answer_patience = std::chrono::seconds{2};
    static constexpr Duration longest_jog_validity = std::chrono::milliseconds{500};
    /// A press of another client is taken again after this long without a renewal (the cycle's own lease is shorter).
    static constexpr Duration jog_session = std::chrono::milliseconds{500};

    /// `log`: a line for each deed; may be empty.
    explicit Gateway(MachineLink& machine, std::function<void(std::string_view)> log = {}) : machine_(machine), deeds_(std::move(log)) {}

    /// 0: too many clients.
    ClientId open(Source source, std::string name, Rights rights);
    /// Its jogs stop; answers still on their way are dropped.
    void close(ClientId client);
    [[nodiscard]] std::size_t client_count() const noexcept { return clients_.size(); }
    [[nodiscard]] const Hands& hands() const noexcept { return hands_; }
    /// "process 812 (taktwerk) of user 1000"; empty: nobody (any more).
    [[nodiscard]] std::string_view name_of(ClientId client) const noexcept;

    /// Before handle(), each service step: commands before the first cycle are refused (there is nobody to carry them out).
    void observe(bool cycling) noexcept { cycling_ = cycling; }
    void handle(const CommandRequest& request, Instant now);
    void step(Instant now);
    std::optional<CommandReply> next_reply();

private:
    struct Entry {
        enum class State : std::uint8_t { empty, waiting, answered, open_again };  ///< open_again: was not taken, may be tried anew
        State state = State::empty;
        CommandRequest request;
        Instant submitted{};
        CommandReply reply;
    };
    struct Client {
        Source source = Source::socket;
        std::string name;
        Rights rights = Rights::operating;
        std::uint64_t highest = 0;
        std::array<Entry, remembered> entries;
        bool set_outputs = false, forces = false;
        bool wrote_values = false;  // pressed a button
        Entry* find(std::uint64_t sequence) noexcept;
    };
    struct JogSession {
        ClientId client = 0;
        Instant renewed{};
        bool live = false;  ///< the machine has accepted it, under this name:
        CommandKind kind = CommandKind::none;
        std::string target{};
        [[nodiscard]] bool is_of(const CommandRequest& request) const { return kind == request.kind && target == request.target; }
    };
    struct Refusal {
        runtime::Answer answer;
        Error error;
    };

    [[nodiscard]] std::optional<Refusal> translate(const Client& client, const CommandRequest& request, Instant now,
                                                   runtime::OperatorCommand& command) const;
    [[nodiscard]] std::optional<Refusal> check_age(const CommandRequest& request, Instant now) const;
    [[nodiscard]] bool is_button(const CommandRequest& request) const;
    [[nodiscard]] Duration validity_of(const CommandRequest& request) const;
    [[nodiscard]] std::optional<Refusal> check_jog(const CommandRequest& request, const runtime::OperatorCommand& command,
                                                   Instant now) const;
    void settle(Client& client, Entry& entry, runtime::Answer answer, axes::ErrorId axis_error, Error error, std::string note = {});
    void keep_jog_session(const Entry& entry, runtime::Answer answer);
    // gateway_deeds.cpp: who did what, and what is his while he is here
    [[nodiscard]] std::string deed(const CommandRequest& request) const;
    void note(ClientId id, const Client& client, const CommandRequest& request, Instant now);
    void note_end(ClientId id, const Client& client);
    void send_endings();
    void raise(const Client& client, const CommandRequest& request, std::uint16_t axis, Instant now);
    void raise_of_group(const Client& client, const CommandRequest& request, std::uint16_t group, Instant now);
    void wait_for(const Client& client, const CommandRequest& request, runtime::StopLevels::Ticket ticket, Instant now);
    void settle_levels(Instant now);
    void let_go(const CommandRequest& request);
    /// What a request that is held, or that moves, holds: its axis, or all axes of its group as they are configured.
    [[nodiscard]] std::vector<std::uint16_t> axes_of(const CommandRequest& request) const;

    MachineLink& machine_;
    bool cycling_ = false;
    ClientId next_client_ = 1;
    std::map<ClientId, Client> clients_;
    std::map<std::uint16_t, JogSession> jogs_;  ///< by axis
    struct Level {                              // raised, until the cycle has taken it
        ClientId client = 0;
        std::uint64_t sequence = 0;
        CommandKind kind = CommandKind::none;
        runtime::StopLevels::Ticket ticket;
        Instant since{};
    };
    std::deque<Level> levels_;
    std::deque<CommandReply> replies_;
    DeedLog deeds_;
    Hands hands_;
    std::map<std::uint16_t, ClientId> told_jogs_;        ///< axes whose jog was told to begin, and of whom
    std::map<std::uint16_t, ClientId> told_group_jogs_;  ///< likewise of groups
    std::deque<runtime::OperatorCommand> endings_;       ///< what ends with clients that are gone; the inbox has not taken it yet
    Instant now_{};
};

}  // namespace taktwerk::hmi
