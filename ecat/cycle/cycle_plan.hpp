#pragma once
// What the cycle runs: the layout of the process data, the slaves' links, and the working area that it needs in each cycle.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "ecat/cycle/bus_health.hpp"
#include "ecat/cycle/cycle_link.hpp"
#include "ecat/cycle/fault_finder.hpp"
#include "ecat/dc/propagation.hpp"
#include "ecat/exchange/exchange.hpp"
#include "ecat/layout/process_data_plan.hpp"

namespace taktwerk::ecat {

/// One configured slave, as the cycle sees it.
struct CycleSlave {
    SlaveLink* link = nullptr;
    const std::atomic<std::uint32_t>* emergency = nullptr;  ///< its last one: code, register << 16; 0: none, or gone
    Duration period{};                                      ///< of its sync unit
    std::int64_t delay = 0;                                 ///< ns from the reference clock to it
};

/// A plan as the cycle runs it: made by the service side, published once, kept until the master dies.
struct CyclePlan {
    CyclePlan(ProcessDataPlan process_data, std::vector<CycleSlave> in_order, FaultFinder finder);

    ProcessDataPlan plan;
    std::vector<CycleSlave> slaves;          ///< as in the configuration
    std::optional<std::uint16_t> reference;  ///< station of the reference clock
    std::vector<std::int64_t> ring_delays;   ///< of a ring: ns from the reference clock, by position, guessed where a slave has no clock
    std::uint16_t reference_position = 0;    ///< meaningful with `reference`
    std::uint16_t state_wkc = 0;             ///< slaves that answer to a broadcast when all is well, besides CycleLink::guests

    /// Where a datagram is under way.
    struct Place {
        static constexpr std::uint8_t nowhere = 0xFF;  ///< it found no slot
        std::uint8_t frame = nowhere;
        std::uint8_t number = 0;  ///< in its frame
    };
    // Working area of the cycle.
    std::uint64_t number = 0;  ///< of the next send(); decides which units are due
    bool sent = false;         ///< and not collected yet
    std::vector<std::byte> outputs, inputs;
    std::vector<SlaveHealth> health;
    FaultFinder faults;
    std::vector<SlotId> frames;           ///< under way; generation 0: none
    std::vector<Place> places;            ///< of each datagram; valid while its unit is under way
    std::vector<std::uint8_t> under_way;  ///< of each unit
    std::vector<Sync0Pulse> sync0;        ///< of each slave
    std::size_t state_number = 0;         ///< of BRD AL status in the first frame; the mailbox bits follow it
};

}  // namespace taktwerk::ecat
