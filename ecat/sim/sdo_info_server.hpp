#pragma once
// The SDO information server: describes the dictionary. A request makes one answer, cut into as many fragments as the mailbox
// needs; the mailbox takes them one after the other. Fixed buffers. Source: ETG.1000.6 5.6.3, SV33-E manual 6.2.8.3.

#include <cstdint>
#include <span>
#include <vector>

#include "ecat/sim/object_dictionary.hpp"
#include "ecat/wire/sdo_info.hpp"

namespace taktwerk::ecat::sim {

class SdoInfoServer {
public:
    explicit SdoInfoServer(const ObjectDictionary& dictionary);

    /// Forgets an answer in progress.
    void reset() noexcept { pending_ = false; }
    /// A request payload without the mailbox header. False: not a request of this service, nothing to answer.
    [[nodiscard]] bool accept(std::span<const std::byte> request) noexcept;
    /// Fragments are waiting.
    [[nodiscard]] bool pending() const noexcept { return pending_; }
    /// The next fragment into `out` (as long as the mailbox allows, at least a header and two bytes); bytes written.
    [[nodiscard]] std::size_t next(std::span<std::byte> out) noexcept;

private:
    /// Bytes of the answer's data, or an abort code in `error_`.
    std::size_t list(std::span<const std::byte> question) noexcept;
    std::size_t object(std::span<const std::byte> question) noexcept;
    std::size_t entry(std::span<const std::byte> question) noexcept;
    std::size_t refuse(std::uint32_t code) noexcept;

    const ObjectDictionary& dictionary_;
    std::vector<std::byte> data_;  // of the whole answer
    std::size_t size_ = 0, done_ = 0;
    SdoInfoOpcode opcode_ = SdoInfoOpcode::error;
    bool pending_ = false;
};

}  // namespace taktwerk::ecat::sim
