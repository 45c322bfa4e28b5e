#pragma once
// Reading a file out of a slave, from message to message: RRQ, then an ACK for each DATA, until one that is not full. No I/O, no time.
// Source: ETG.1000.6 (FoE).
//
//   the DATA that is due             kept and acknowledged; one that is not full is the last
//   the DATA before                  an answer that came twice: skipped
//   any other DATA                   broken (8005h)
//   more than `limit` bytes          broken (8003h)
//   BUSY                             the last ACK again; ACK 0 where no DATA came yet, for an RRQ would begin anew
//   ERR illegal to the first RRQ     as FileWriting
//   ERR                              refused
//   ACK, RRQ, WRQ                    broken (8004h)

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ecat/foe/foe_step.hpp"
#include "ecat/wire/foe.hpp"

namespace taktwerk::ecat {

class FileReading {
public:
    /// `room`: foe_room() of the mailbox that the slave writes.
    FileReading(FoeFile what, std::size_t room, std::size_t limit) noexcept : what_(std::move(what)), room_(room), limit_(limit) {}

    /// What is sent now. A view of itself.
    [[nodiscard]] FoeMessage request() const noexcept;
    [[nodiscard]] FoeStep answer(const FoeMessage& message);

    [[nodiscard]] const std::vector<std::byte>& file() const noexcept { return file_; }
    [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(file_); }

private:
    FoeFile what_;
    std::size_t room_, limit_;
    std::vector<std::byte> file_;
    std::uint32_t packet_ = 0;  ///< that came last
    bool asked_twice_ = false, accepted_ = false;
};

}  // namespace taktwerk::ecat
