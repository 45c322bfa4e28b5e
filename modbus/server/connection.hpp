#pragma once
// The bytes of one client: what has come, what has to go. One request is under way at a time; until its answer has left, nothing further is read, so a
// client that sends without end or never reads fills its own buffers and nobody else's.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/time.hpp"
#include "modbus/server/answer.hpp"

namespace taktwerk::modbus::server {

class Connection {
public:
    /// Takes the socket, which does not block.
    Connection(int socket, std::uint64_t number, std::string who, Instant now)
        : socket_(socket), number_(number), who_(std::move(who)), answered_(now) {}
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    [[nodiscard]] int socket() const noexcept { return socket_; }
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }
    [[nodiscard]] const std::string& who() const noexcept { return who_; }
    /// When its last answer had left whole, or it came.
    [[nodiscard]] Instant answered() const noexcept { return answered_; }

    /// Reads what is there. False: the client has ended the connection, or it broke.
    [[nodiscard]] bool receive();
    /// The frame that has come first; it stays until drop().
    [[nodiscard]] Frame frame() const noexcept { return frame_of({bytes_.data(), size_}); }
    void drop(const Frame& frame) noexcept;

    void answer(const AnswerFrame& frame) noexcept {
        out_ = frame;
        sent_ = 0;
    }
    /// Sends what is left of the answer. False: the connection broke.
    [[nodiscard]] bool send(Instant now);
    [[nodiscard]] bool sending() const noexcept { return sent_ < out_.size; }

    /// A write that the machine has not judged yet.
    struct Waiting {
        std::uint64_t order = 0;
        AnswerTo to;
        AnswerFrame done;  ///< if it is carried out
        Instant since{};
    };
    std::optional<Waiting> waiting;
    bool has_ordered = false;  ///< ever: then the machine hears that it is gone

private:
    int socket_;
    std::uint64_t number_;
    std::string who_;
    Instant answered_;
    std::array<std::uint8_t, 2 * most_frame_bytes> bytes_{};
    std::size_t size_ = 0;
    AnswerFrame out_;
    std::size_t sent_ = 0;
};

}  // namespace taktwerk::modbus::server
