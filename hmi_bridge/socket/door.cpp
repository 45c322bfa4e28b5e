#include "hmi_bridge/socket/door.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "hmi_bridge/socket/answer_line.hpp"
#include "hmi_bridge/socket/peer_name.hpp"

namespace taktwerk::hmi {

using runtime::StopLevels;

namespace {

/// Far more than any client reads at once; each connection has its own bound in the server.
constexpr std::size_t most_answer_bytes = std::size_t{16} << 20;

Error unclear_axis() {
    return {"request.unclear_axis", "axis", "names no axis of this machine, so nobody can tell what is to stop: every axis stops",
            "Give the name of an axis, or leave \"axis\" out to stop all."};
}

const Error& no_place() {
    static const Error error{
        "socket.too_many_clients", "",
        fmt::format("{} clients are connected already; this connection may only stop and shut down", SocketServer::max_connections),
        "Close one of them."};
    return error;
}

}  // namespace

Door::Door(MachineLink& machine, std::unique_ptr<SocketServer> server, std::function<void(std::string_view)> log)
    : machine_(machine), server_(std::move(server)), deeds_(std::move(log)) {}

bool Door::holds(ConnectionId connection) const {
    return std::any_of(holds_.begin(), holds_.end(), [&](const auto& hold) { return hold.second.connection == connection; });
}

bool Door::let_go(ConnectionId connection, std::uint16_t axis) {
    bool raised = false;
    for (auto hold = holds_.lower_bound(axis); hold != holds_.end() && hold->first == axis;) {
        if (hold->second.connection != connection) {
            ++hold;
            continue;
        }
        if (now_ - hold->second.renewed <= jog_hold) {
            machine_.release_jog(axis);
            raised = true;
        }
        hold = holds_.erase(hold);
    }
    return raised;
}

void Door::on_open(ConnectionId connection, const Peer& peer) {
    guests_[connection] = {peer.in_reserve, peer_name(peer)};
    if (peer.in_reserve) return;
    const std::lock_guard lock{mutex_};
    queues_[connection].peer = peer;
}

void Door::on_close(ConnectionId connection) {
    // A lost client first lets go of what it held.
    for (std::size_t axis = 0; axis < machine_.layout().axes.size(); ++axis) let_go(connection, static_cast<std::uint16_t>(axis));
    std::erase_if(pending_, [&](const Pending& p) { return p.connection == connection; });
    guests_.erase(connection);
    const std::lock_guard lock{mutex_};
    if (const auto queue = queues_.find(connection); queue != queues_.end()) queue->second.closed = true;
}

void Door::on_line(ConnectionId connection, std::string_view line, Instant) {
    Arrival arrival;
    const auto urgent = urgent_line(line, machine_.layout());
    using Kind = UrgentLine::Kind;
    if (urgent && (urgent->kind == Kind::stop || urgent->kind == Kind::shutdown)) {
        const auto ticket = urgent->kind == Kind::stop ? machine_.request_stop(urgent->axis) : machine_.request_shutdown();
        const auto deed = urgent->kind == Kind::shutdown ? std::string("shutdown")
                          : urgent->axis == 0xFFFF       ? std::string("stop")
                                                         : "stop axis " + machine_.layout().axes[urgent->axis].name;
        deeds_.say(guests_[connection].name, deed, now_);
        if (urgent->unclear) return hand_on(connection, line, {read_at_, machine_.levels_raised(), false});
        if (urgent->unclear_axis) server_->send(connection, refusal_line(urgent->id, unclear_axis()));
        else pending_.push_back({connection, urgent->id, urgent->kind, ticket, now_});
        return;
    }
    if (urgent && urgent->kind == Kind::jog_release) {
        arrival.level_raised = !urgent->held.empty();
        for (const auto axis : urgent->held) arrival.level_raised = let_go(connection, axis) && arrival.level_raised;
    }
    arrival.at = read_at_;
    arrival.after = machine_.levels_raised();
    if (urgent && urgent->kind == Kind::jog_hold) {
        for (const auto axis : urgent->held) {
            for (auto hold = holds_.lower_bound(axis); hold != holds_.end() && hold->first == axis; ++hold)
                if (hold->second.connection == connection) hold->second.renewed = now_;
            if (urgent->press && !guests_[connection].in_reserve) {
                // The first one stays: should this press be refused, what was held before it is held still. Those between are no more.
                bool first = true;
                std::erase_if(holds_, [&](const auto& h) {
                    return h.first == axis && h.second.connection == connection && !std::exchange(first, false);
                });
                holds_.insert({axis, {connection, urgent->id, now_}});
            }
        }
    }
    hand_on(connection, line, arrival);
}

void Door::hand_on(ConnectionId connection, std::string_view line, const Arrival& arrival) {
    if (guests_[connection].in_reserve) {
        server_->send(connection, refusal_line("null", no_place()));
        return;
    }
    bool full = false;
    {
        const std::lock_guard lock{mutex_};
        auto& queue = queues_[connection];
        full = queue.lines.size() >= lines_waiting || queue.bytes + line.size() > bytes_waiting;
        if (!full) {
            queue.bytes += line.size();
            queue.lines.push_back({std::string(line), arrival});
        }
    }
    if (full)
        server_->send(connection,
                      refusal_line("null", {"command.queue_full", "",
                                            fmt::format("{} lines of this client wait already; this one was not taken", lines_waiting),
                                            "Wait for the answers, then give it again."}));
}

void Door::settle_pending(Instant now) {
    for (auto p = pending_.begin(); p != pending_.end();) {
        const bool taken = machine_.taken(p->ticket);
        if (!taken && now - p->since < patience) {
            ++p;
            continue;
        }
        if (taken) {
            server_->send(p->connection, accepted_line(p->id));
        } else {
            const auto stuck = machine_.stuck();
            const bool ends = p->kind == UrgentLine::Kind::shutdown;
            server_->send(
                p->connection,
                refusal_line(p->id, {"command.no_answer", "", stuck ? *stuck : "the cycle has not taken it yet",
                                     ends ? "The process ends by itself in the promised time; the drives stop by their own watchdogs. "
                                            "Use the emergency stop."
                                          : "The stop stands and acts in the next cycle, if one comes. Use the emergency stop."}));
        }
        p = pending_.erase(p);
    }
}

void Door::send_answers() {
    std::deque<Answer> out;
    {
        const std::lock_guard lock{mutex_};
        out.swap(answers_);
        answer_bytes_ = 0;
    }
    for (const auto& answer : out) {
        // A press that was refused holds nothing.
        if (!answer.refused.empty())
            std::erase_if(holds_, [&](const auto& hold) {
                return hold.second.connection == answer.connection && hold.second.press == answer.refused;
            });
        server_->send(answer.connection, answer.text);
    }
}

void Door::step(Instant now) {
    // What is read now came after the last look. Where that was long ago (the process stood still) it may be as old as that.
    read_at_ = looked_ != Instant{} && now - looked_ > unseen ? looked_ : now;
    now_ = now;
    send_answers();
    server_->step(now, *this);
    if (also) also(now);
    settle_pending(now);
    looked_ = now;
}

void Door::pass_on(RequestHandler& handler, Instant now) {
    struct Share {
        ConnectionId connection = 0;
        Peer peer;
        bool opens = false, closes = false, gone = false;
        std::vector<Waiting> lines;
    };
    std::vector<Share> shares;
    {
        const std::lock_guard lock{mutex_};
        for (auto entry = queues_.begin(); entry != queues_.end();) {
            auto& queue = entry->second;
            Share share{entry->first, queue.peer, !queue.opened, false, queue.closed, {}};
            queue.opened = true;
            for (std::size_t bytes = 0; !queue.lines.empty() && share.lines.size() < lines_per_step && bytes < bytes_per_step;) {
                bytes += queue.lines.front().text.size();
                queue.bytes -= queue.lines.front().text.size();
                share.lines.push_back(std::move(queue.lines.front()));
                queue.lines.pop_front();
            }
            share.closes = queue.closed && queue.lines.empty();
            shares.push_back(std::move(share));
            if (shares.back().closes) entry = queues_.erase(entry);
            else ++entry;
        }
    }
    for (const auto& share : shares) {
        if (share.opens) handler.on_open(share.connection, share.peer);
        for (const auto& line : share.lines)
            if (!share.gone || now - line.arrival.at <= after_close) handler.on_request(share.connection, line.text, now, line.arrival);
        if (share.closes) handler.on_close(share.connection);
    }
}

void Door::answer(ConnectionId connection, std::string text, std::string refused) {
    {
        const std::lock_guard lock{mutex_};
        if (answer_bytes_ + text.size() > most_answer_bytes) return;
        answer_bytes_ += text.size();
        answers_.push_back({connection, std::move(text), std::move(refused)});
    }
    server_->wake();
}

}  // namespace taktwerk::hmi
