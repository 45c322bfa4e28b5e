#pragma once
// The file server of a simulated slave, as the usual slave stacks play it: one transfer at a time; what does not belong to it ends it with
// "illegal" (8004h); a packet out of turn ends it with 8005h; BUSY while its flash works, and the same packet is wanted again; an ERR of
// the master ends it without an answer. Source: ETG.1000.6 (FoE).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ecat/sim/mailbox_service.hpp"
#include "ecat/sim/slave_files.hpp"
#include "ecat/wire/foe.hpp"

namespace taktwerk::ecat::sim {

/// What goes wrong with files on demand.
struct FoeFaults {
    std::uint32_t busy = 0;                   ///< so many requests more are answered with BUSY
    bool stays_busy = false;                  ///< all of them, and it gets no further
    std::uint32_t silent = 0;                 ///< so many requests more are not answered at all
    std::optional<std::uint32_t> fails_at{};  ///< packet that ends in `fails_with`
    std::uint32_t fails_with = 0;
};

class FoeServer final : public MailboxService {
public:
    explicit FoeServer(SlaveFiles& files) noexcept : files_(files) {}

    void start() noexcept override;
    void set_rooms(std::size_t from_master, std::size_t to_master) noexcept override {
        taken_at_once_ = from_master > foe_header_size ? from_master - foe_header_size : 0;
        room_ = to_master > foe_header_size ? to_master - foe_header_size : 0;
    }
    std::size_t serve(std::span<const std::byte> message, std::span<std::byte> out, EsmState state, Instant now) noexcept override;

    [[nodiscard]] FoeFaults& faults() noexcept { return faults_; }

private:
    enum class Doing : std::uint8_t { nothing, sending, taking };

    std::size_t answer(const FoeMessage& message, std::span<std::byte> out, EsmState state, Instant now);
    std::uint32_t open(const FoeMessage& message, EsmState state);
    std::size_t begin_read(const FoeMessage& message, std::span<std::byte> out, EsmState state);
    std::size_t begin_write(const FoeMessage& message, std::span<std::byte> out, EsmState state, Instant now);
    std::size_t go_on_reading(const FoeMessage& message, std::span<std::byte> out);
    std::size_t take_data(const FoeMessage& message, std::span<std::byte> out, Instant now);
    std::size_t send_piece(std::span<std::byte> out) noexcept;
    std::size_t say_busy(std::span<std::byte> out, unsigned percent) const noexcept;
    std::size_t end_with(std::span<std::byte> out, std::uint32_t code) noexcept;

    SlaveFiles& files_;
    FoeFaults faults_;
    std::size_t taken_at_once_ = 0, room_ = 0;  ///< file bytes in a full packet from and to the master
    Doing doing_ = Doing::nothing;
    std::uint32_t packet_ = 0;  ///< sending: the one that was sent last; taking: the one that is due
    std::size_t sent_ = 0;      ///< bytes before that packet
    bool last_sent_ = false, closing_ = false;
};

}  // namespace taktwerk::ecat::sim
