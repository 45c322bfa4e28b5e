#pragma once
// All clients of this machine's Modbus TCP server. Nothing in it waits but wait(): sockets do not block, each client has one request under way and a
// share of every step, and a client that is silent, slow, broken or never reads is let go after `idle`.
//
//   thread of the server    wait(), step()             in real time a thread of its own (apps/machine/run.cpp)
//   service thread          image(), publish(), orders()
//
// Not by libmodbus: its server (3.1.6) waits in modbus_receive() for the rest of a frame, sleeps for its response time-out before it refuses a quantity,
// and sends with a call that blocks. Measured on loopback, a second client's answer comes after 0.5 s when another has sent half a frame or asked for 200
// registers, after 4.4 s when it sends a byte each 400 ms, and never when it does not read its own answers. Its map is one range a table: it knows
// neither an address between two others that nobody offers, nor one that may not be written, nor exception 4.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/latest_value.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "modbus/server/connection.hpp"
#include "modbus/server/order_book.hpp"
#include "modbus/server/register_map.hpp"
#include "modbus/server/server_config.hpp"

namespace taktwerk::modbus::server {

class Server {
public:
    static constexpr int requests_per_step = 16;                              ///< of one client
    static constexpr Duration order_patience = std::chrono::seconds{4};       ///< for the machine's verdict on a write; then exception 4
    static constexpr Duration accept_pause = std::chrono::milliseconds{100};  ///< when the system gives no more sockets
    static constexpr Duration between_lines = std::chrono::seconds{10};       ///< of the log about clients that misbehave

    /// Listens at once; the map does not change any more. `log`: called by the thread of the server; may be empty.
    /// Errors: served.listen.
    static Result<std::unique_ptr<Server>> open(const ServerConfig& config, std::vector<ServedRegister> registers,
                                                std::function<void(std::string_view)> log = {});
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    // --- thread of the server ---------------------------------------------------------------------------------------------------------
    /// Until something comes, or `most` has passed.
    void wait(Duration most);
    void step(Instant now);
    [[nodiscard]] std::size_t client_count() const noexcept { return connections_.size(); }

    // --- service thread ----------------------------------------------------------------------------------------------------------------
    /// The image to fill: all of its words, then publish().
    [[nodiscard]] ServedImage& image() noexcept { return images_.back(); }
    void publish() noexcept { images_.publish(); }
    [[nodiscard]] OrderBook& orders() noexcept { return orders_; }

    // --- any thread ---------------------------------------------------------------------------------------------------------------------
    [[nodiscard]] const RegisterMap& map() const noexcept { return map_; }
    [[nodiscard]] const ServerConfig& config() const noexcept { return config_; }
    [[nodiscard]] std::uint16_t port() const noexcept { return config_.listen.port; }

private:
    Server(const ServerConfig& config, std::vector<ServedRegister> registers, int listener, std::function<void(std::string_view)> log);

    void accept(Instant now);
    void take_verdicts();
    /// False: the connection ends.
    [[nodiscard]] bool serve(Connection& connection, Instant now);
    void answer(Connection& connection, const Frame& frame, Instant now);
    void order(Connection& connection, const AnswerTo& to, const Request& request, Instant now);
    [[nodiscard]] bool too_slow(const Connection& connection, Instant now) const;
    void say(Instant now, const std::string& text);

    ServerConfig config_;
    RegisterMap map_;
    int listener_;
    std::function<void(std::string_view)> log_;
    std::vector<std::unique_ptr<Connection>> connections_;
    std::uint64_t last_connection_ = 0, last_order_ = 0;
    Instant accept_again_{};
    bool accepting_ = true;
    Instant said_{};
    std::uint64_t unsaid_ = 0;
    std::size_t first_ = 0;  // whose turn it is to be first
    const ServedImage* image_ = nullptr;
    LatestValue<ServedImage> images_;
    OrderBook orders_;
};

}  // namespace taktwerk::modbus::server
