#pragma once
// A machine as its local socket shows it, on a thread of its own: answers as a machine does, remembers what was asked and by which connection.

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/clock.hpp"
#include "hmi_bridge/socket/socket_server.hpp"

namespace taktwerk::hmi::web {

class SocketMachine : private LineHandler {
public:
    struct Asked {
        ConnectionId connection;
        nlohmann::json request;
        Instant at;
    };

    SocketMachine(std::string name, std::string path) : name_(std::move(name)), path_(std::move(path)) { start(); }
    ~SocketMachine() { stop(); }
    SocketMachine(const SocketMachine&) = delete;
    SocketMachine& operator=(const SocketMachine&) = delete;

    void start() {
        auto opened = SocketServer::open(path_, [](std::string_view) {});
        if (!opened) return;
        server_ = std::move(*opened);
        ends_ = false;
        thread_ = std::thread([this] {
            while (!ends_) {
                server_->wait(std::chrono::milliseconds{5});
                server_->step(SystemClock{}.now(), *this);
            }
        });
    }
    void stop() {
        ends_ = true;
        if (thread_.joinable()) thread_.join();
        server_.reset();
    }
    [[nodiscard]] const std::string& path() const { return path_; }
    /// What came, in order, but what the server asks for by itself (hello, layout, state).
    std::vector<Asked> asked() {
        const std::lock_guard lock(mutex_);
        return asked_;
    }
    std::vector<Asked> asked(const std::string& cmd) {
        auto all = asked();
        std::erase_if(all, [&](const Asked& one) { return one.request.value("cmd", "") != cmd; });
        return all;
    }
    std::size_t connections() {
        const std::lock_guard lock(mutex_);
        return open_;
    }

    std::atomic<bool> stands{false};             ///< the cycle does not advance
    std::atomic<bool> silent{false};             ///< nothing is answered
    std::atomic<std::size_t> long_answer{1024};  ///< bytes of the answer to scope_read

    std::string odd_hello;  ///< the answer to hello behind its id, of something that is no machine; set while it is stopped

private:
    void on_open(ConnectionId connection, const Peer& peer) override {
        const std::lock_guard lock(mutex_);
        ++open_;
        if (peer.in_reserve) in_reserve_.insert(connection);
    }
    void on_close(ConnectionId connection) override {
        const std::lock_guard lock(mutex_);
        --open_;
        in_reserve_.erase(connection);
    }
    void on_line(ConnectionId connection, std::string_view line, Instant now) override {
        const auto request = nlohmann::json::parse(line, nullptr, false);
        if (!request.is_object()) return;
        const auto cmd = request.value("cmd", "");
        if (in_reserve_.count(connection) != 0 && cmd != "stop" && cmd != "shutdown") {
            server_->send(connection,
                          R"({"id":null,"ok":false,"error":{"code":"socket.too_many_clients","subject":"","what":"full","remedy":""}})");
            return;
        }
        const bool by_itself = cmd == "hello" || cmd == "layout" || cmd == "state";
        if (!by_itself) {
            const std::lock_guard lock(mutex_);
            asked_.push_back({connection, request, now});
        }
        if (silent) return;
        const auto answer = [&](const std::string& more) {
            server_->send(connection, R"({"id":)" + std::to_string(request.value("id", 0)) + more + "}");
        };
        if (cmd == "hello" && !odd_hello.empty()) return answer(odd_hello);
        if (cmd == "hello") return answer(R"(,"ok":true,"hello":{"machine":")" + name_ + "\"}");
        if (cmd == "layout") return answer(R"(,"ok":true,"layout":{"machine":")" + name_ + R"(","axes":[{"name":"x"}]})");
        if (cmd == "state") {
            if (!stands) ++cycle_;
            return answer(R"(,"ok":true,"state":{"machine":")" + name_ + R"(","cycle":)" + std::to_string(cycle_) + R"(,"axes":[]})");
        }
        if (cmd == "scope_read") return answer(R"(,"ok":true,"data":")" + std::string(long_answer, 'A') + "\"");
        if (cmd == "home") return answer(R"(,"ok":false,"error":{"code":"command.wrong_mode","subject":"x","what":"no","remedy":"do"})");
        answer(R"(,"ok":true)");
    }

    std::string name_, path_;
    std::unique_ptr<SocketServer> server_;
    std::thread thread_;
    std::atomic<bool> ends_{false};
    std::mutex mutex_;
    std::vector<Asked> asked_;
    std::size_t open_ = 0;
    std::set<ConnectionId> in_reserve_;
    std::int64_t cycle_ = 0;
};

}  // namespace taktwerk::hmi::web
