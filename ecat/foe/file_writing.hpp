#pragma once
// Writing a file into a slave, from message to message: WRQ, then DATA 1, 2, ... each when the one before was acknowledged, until one that
// is not full. No I/O, no time. Source: ETG.1000.6 (FoE).
//
//   ACK of what was sent             the next packet, or done
//   ACK of an earlier packet         an answer that came twice: skipped; so is any but ACK 0 to the WRQ: of an earlier transfer
//   ACK of a later packet            broken (8005h)
//   BUSY                             the same again: the slave has not taken it
//   ERR illegal to the first WRQ     the slave still has an earlier transfer in its head, and ends it with that: WRQ once more
//   ERR                              refused
//   DATA, RRQ, WRQ                   broken (8004h)

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ecat/foe/foe_step.hpp"
#include "ecat/wire/foe.hpp"

namespace taktwerk::ecat {

class FileWriting {
public:
    /// `file` outlives it. `room`: foe_room() of the mailbox that the slave reads.
    FileWriting(FoeFile what, std::span<const std::byte> file, std::size_t room) noexcept
        : what_(std::move(what)), file_(file), room_(room) {}

    /// What is sent now. A view of the file and of itself.
    [[nodiscard]] FoeMessage request() const noexcept;
    [[nodiscard]] FoeStep answer(const FoeMessage& message);

    [[nodiscard]] std::size_t size() const noexcept { return file_.size(); }
    /// Bytes that the slave has acknowledged.
    [[nodiscard]] std::size_t acknowledged() const noexcept { return acknowledged_; }
    /// It has taken the request for the file.
    [[nodiscard]] bool begun() const noexcept { return packet_ > 0; }

private:
    [[nodiscard]] std::span<const std::byte> piece() const noexcept;

    FoeFile what_;
    std::span<const std::byte> file_;
    std::size_t room_;
    std::uint32_t packet_ = 0;  ///< that is sent now; 0: the request
    std::size_t acknowledged_ = 0;
    bool asked_twice_ = false;
};

}  // namespace taktwerk::ecat
