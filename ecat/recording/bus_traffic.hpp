#pragma once
// Who speaks on a cable, what, how often, and what became of it: from frames alone, in the order in which they were heard. Not real-time.
//
// A frame that leaves this computer was sent; of others those were sent whose first byte of the source no slave has marked (ETG.1000.4: every
// slave sets the bit of a locally administered address), and the rest came back. So of some masters nothing is known to be sent: at a tap of one whose
// own address has that bit, and on the interface of one that bypasses the kernel's queue, as Taktwerk does (packet(7): such frames pass
// listeners by). Their cycle is that of the frames that come back.

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/wire/frame.hpp"

namespace taktwerk::ecat {

/// One kind of datagram of a master.
struct DatagramTraffic {
    Command command{};
    Address address;  ///< of ADO alone where ADP counts slaves
    std::size_t size = 0;
    std::uint64_t sent = 0;
    std::map<std::uint16_t, std::uint64_t> working_counters;  ///< of those that came back: how often
};

/// When frames of one direction came: those that follow each other within 50 us are one cycle's.
struct CycleTraffic {
    std::uint64_t cycles = 0;        ///< from one to the next
    Duration shortest{}, longest{};  ///< of them
    Instant first{}, last{};         ///< their beginnings

    void note(Instant at) noexcept;

private:
    Instant newest_{};
    bool begun_ = false;
};

struct MasterTraffic {
    MacAddress address{};
    std::uint64_t sent = 0, back = 0;
    std::uint64_t damaged = 0;  ///< no whole EtherCAT frames
    CycleTraffic sending, returning;
    std::vector<DatagramTraffic> datagrams;
    std::uint64_t other_datagrams = 0;  ///< of more kinds than are told apart

    /// Of what it sends, where that is heard.
    [[nodiscard]] const CycleTraffic& cycle() const noexcept { return sent > 0 ? sending : returning; }
};

class BusTraffic {
public:
    static constexpr std::size_t most_masters = 8, most_kinds = 64;

    /// Any bytes are safe. `at` does not fall. `outgoing`: of this computer.
    void note(std::span<const std::byte> frame, Instant at, bool outgoing);

    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
    /// Too short to have a sender, or of more masters than are told apart.
    [[nodiscard]] std::uint64_t others() const noexcept { return others_; }
    /// In the order in which they were first heard.
    [[nodiscard]] const std::vector<MasterTraffic>& masters() const noexcept { return masters_; }

private:
    [[nodiscard]] MasterTraffic* sender_of(std::span<const std::byte> frame);

    std::vector<MasterTraffic> masters_;
    std::uint64_t frames_ = 0, others_ = 0;
};

}  // namespace taktwerk::ecat
