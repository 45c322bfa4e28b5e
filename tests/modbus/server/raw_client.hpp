#pragma once
// A Modbus TCP client as bytes on a socket, and a server that is stepped by hand: its time is the test's.

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "modbus/server/server.hpp"
#include "tests/patience.hpp"

namespace taktwerk::modbus::server::testing {

using RawBytes = std::vector<std::uint8_t>;

/// Header with this transaction and unit, and the PDU.
inline RawBytes framed(const RawBytes& pdu, std::uint8_t transaction = 1, std::uint8_t unit = 1) {
    RawBytes out{0, transaction, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), unit};
    out.insert(out.end(), pdu.begin(), pdu.end());
    return out;
}

class RawClient {
public:
    explicit RawClient(std::uint16_t port, int receive_buffer = 0) {
        socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (receive_buffer > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
        ::fcntl(socket_, F_SETFL, O_NONBLOCK);
    }
    ~RawClient() { ::close(socket_); }
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;

    bool connected() const { return connected_; }
    /// How many bytes the kernel took.
    std::size_t send(const RawBytes& bytes) const {
        const auto count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        return count < 0 ? 0 : static_cast<std::size_t>(count);
    }
    /// What has come so far.
    RawBytes take() {
        std::uint8_t bytes[4096];
        for (;;) {
            const auto count = ::recv(socket_, bytes, sizeof bytes, 0);
            if (count > 0) {
                heard_.insert(heard_.end(), bytes, bytes + count);
                continue;
            }
            ended_ = ended_ || count == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
            return std::exchange(heard_, {});
        }
    }
    /// The server has ended the connection.
    bool ended() {
        auto kept = take();
        heard_ = std::move(kept);
        return ended_;
    }

private:
    int socket_ = -1;
    bool connected_ = false, ended_ = false;
    RawBytes heard_;
};

/// Input registers 0 and 1 (a float32) and 2 (uint16), holding register 0 and coils 0 and 1, which may be written.
class ServedRig {
public:
    explicit ServedRig(ServerConfig config = {}) {
        config.listen.port = 0;
        const auto add = [this](const char* name, Table table, std::uint16_t address, NumberType type, bool writable) {
            registers.push_back({name, table, address, type, WordOrder::high_first, 0, writable});
        };
        add("position", Table::input, 0, NumberType::float32, false);
        add("count", Table::input, 2, NumberType::uint16, false);
        add("speed", Table::holding, 0, NumberType::uint16, true);
        add("lamp", Table::coil, 0, NumberType::boolean, true);
        add("horn", Table::coil, 1, NumberType::boolean, true);
        auto opened = Server::open(config, registers, [this](std::string_view line) { log.emplace_back(line); });
        if (!opened) {
            ADD_FAILURE() << opened.error().text();
            return;
        }
        server = std::move(opened).value();
        publish({-12.5, 7, 0, 0, 0});
    }
    void publish(const std::vector<double>& numbers) {
        auto& image = server->image();
        image.ever = true, image.at = now;
        for (std::size_t i = 0; i < numbers.size(); ++i) image.words[i] = words_of(registers[i], numbers[i]);
        server->publish();
    }
    void step() { server->step(now); }
    /// Until `done`; false: it did not come.
    template <class Done>
    bool until(Done done) {
        bool is_done = done();
        for (taktwerk::Patience patience; patience.lasts(!is_done); is_done = done()) step();
        return is_done;
    }
    /// Sends a frame, and steps until an answer has come.
    RawBytes ask(RawClient& client, const RawBytes& frame) {
        client.send(frame);
        RawBytes answer;
        until([&] {
            const auto more = client.take();
            answer.insert(answer.end(), more.begin(), more.end());
            return answer.size() > 6 && answer.size() >= 6u + answer[5];
        });
        return answer;
    }

    std::vector<ServedRegister> registers;
    std::vector<std::string> log;
    std::unique_ptr<Server> server;
    Instant now{std::chrono::seconds{100}};
};

}  // namespace taktwerk::modbus::server::testing
