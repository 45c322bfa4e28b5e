#pragma once
// One connection to a machine's local socket: requests as they are, answers by their id. Included by web_server.cpp alone.

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "hmi_bridge/web/machine_answer.hpp"
#include "hmi_bridge/web/server/beast.hpp"

namespace taktwerk::hmi::web {

constexpr Duration answer_patience = 3s;  ///< longer than the gateway waits for the cycle
constexpr Duration drive_patience = 12s;  ///< a drive's EEPROM

class MachineLine : public std::enable_shared_from_this<MachineLine> {
public:
    using Answer = std::function<void(const MachineAnswer&)>;

    MachineLine(asio::io_context& io, std::string path) : socket_(io), in_(MachineAnswer::longest), path_(std::move(path)) {}

    void open() {
        socket_.async_connect(local::endpoint(path_), [self = shared_from_this()](error_code failure) {
            if (failure) return self->close("cannot connect: " + failure.message());
            self->connected_ = true;
            self->read();
            self->write();
        });
    }
    /// Everybody who waits is answered.
    void close(const std::string& why) {
        close_with(failed_answer({"socket.closed", path_, why, "See that the machine runs, then give the command again."}));
    }
    void ask(Json request, Duration patience, Answer answer) {
        if (out_.size() >= most_unsent) close("the machine reads nothing");  // and what this connection held ends
        if (closed_)
            return answer(
                failed_answer({"web.no_machine", path_, "there is no connection to the machine", "Start it with `taktwerk run FILE`."}));
        const auto id = next_id_++;
        request["id"] = id;
        waiting_[id] = Waiting{std::move(answer), now() + patience};
        out_.push_back(text_of(request) + "\n");
        if (connected_ && out_.size() == 1) write();
    }
    /// Answers what nobody answered in time.
    void expire(Instant at) {
        for (auto one = waiting_.begin(); one != waiting_.end();) {
            if (one->second.until > at) {
                ++one;
                continue;
            }
            const auto answer = std::move(one->second.answer);
            one = waiting_.erase(one);
            answer(failed_answer({"socket.timeout", path_, "the runtime did not answer in time", "Look at the runtime's output."}));
            if (closed_) return;
        }
    }
    [[nodiscard]] bool closed() const { return closed_; }
    /// The machine has given it a place: it has answered.
    [[nodiscard]] bool proven() const { return proven_ && !closed_; }
    [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

private:
    static constexpr std::size_t most_unsent = 256;  ///< requests that the kernel did not take yet

    struct Waiting {
        Answer answer;
        Instant until;
    };

    void close_with(const MachineAnswer& answer) {
        if (closed_) return;
        closed_ = true;
        error_code ignored;
        socket_.close(ignored);
        for (auto& one : std::exchange(waiting_, {})) one.second.answer(answer);
    }
    void write() {
        if (out_.empty() || closed_) return;
        asio::async_write(socket_, asio::buffer(out_.front()), [self = shared_from_this()](error_code failure, std::size_t) {
            if (failure) return self->close("the machine has closed the connection");
            self->out_.pop_front();
            self->write();
        });
    }
    void read() {
        asio::async_read_until(socket_, in_, '\n', [self = shared_from_this()](error_code failure, std::size_t bytes) {
            if (failure || self->closed_) return self->close("the machine has closed the connection");
            auto answer = read_machine_answer({static_cast<const char*>(self->in_.data().data()), bytes});
            self->in_.consume(bytes);
            if (answer) self->take(*answer);
            if (!self->closed_) self->read();
        });
    }
    void take(const NumberedAnswer& answer) {
        // Said to nobody's request: that it takes no more clients, and the like. Its own words are the answer.
        if (!answer.id) return answer.answer.ok ? close("the machine takes no more clients") : close_with(answer.answer);
        proven_ = true;
        const auto found = waiting_.find(*answer.id);
        if (found == waiting_.end()) return;
        const auto done = std::move(found->second.answer);
        waiting_.erase(found);
        done(answer.answer);
    }

    local::socket socket_;
    asio::streambuf in_;
    std::string path_;
    std::deque<std::string> out_;
    std::map<std::int64_t, Waiting> waiting_;
    std::int64_t next_id_ = 1;
    bool connected_ = false, proven_ = false, closed_ = false;
};

}  // namespace taktwerk::hmi::web
