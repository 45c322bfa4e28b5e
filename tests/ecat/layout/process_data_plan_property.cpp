// What holds for every plan, whatever the slaves. The test walks from a mapped object through image, datagram and FMMU to the
// slave's memory by itself, bit by bit, and adds up working counters as each slave does (ETG.1000.4).
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "ecat/layout/frame_schedule.hpp"
#include "ecat/layout/process_data_plan.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat {
namespace {

struct Bus {
    std::vector<PlanSlave> slaves;
    std::vector<SyncUnitConfig> units;
};

class RandomBus {
public:
    explicit RandomBus(unsigned seed) : random_(seed) {}
    Bus next() {
        Bus bus;
        const auto unit_count = 1 + below(4);
        for (std::uint32_t u = 0; u < unit_count; ++u)
            bus.units.push_back({"unit" + std::to_string(u), static_cast<std::uint16_t>(1 + below(6))});
        const auto count = 1 + below(below(8) == 0 ? 120 : 12);
        for (std::uint32_t i = 0; i < count; ++i) {
            bus.slaves.push_back(slave());
            bus.slaves.back().subject = "slave " + std::to_string(i);
            if (below(2) == 0) bus.slaves.back().sync_unit = bus.units[below(unit_count)].name;
        }
        return bus;
    }

private:
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

    PlanSlave slave() {
        PlanSlave s;
        s.coe = below(2) == 0;
        s.lrw = below(6) != 0;
        s.bitwise_fmmu = below(4) != 0;
        if (s.coe) {
            s.sync_managers = {{SmUse::mailbox_out, 0x1000, 0x80, 0x26}, {SmUse::mailbox_in, 0x1080, 0x80, 0x22}};
            if (below(8) != 0) s.mailbox_in = std::uint8_t{1};
        }
        std::uint16_t address = 0x1100;
        const auto managers = below(4);
        for (std::uint32_t i = 0; i < managers; ++i) add_manager(s, below(2) == 0 ? SmUse::outputs : SmUse::inputs, address);
        return s;
    }

    void add_manager(PlanSlave& s, SmUse use, std::uint16_t& address) {
        const auto number = static_cast<std::uint8_t>(s.sync_managers.size());
        auto& pdos = use == SmUse::outputs ? s.rx : s.tx;
        const auto index = static_cast<std::uint16_t>((use == SmUse::outputs ? 0x1600 : 0x1A00) + number * 0x10);
        const bool huge = below(12) == 0;
        std::uint32_t bits = 0;
        const auto pdo_count = 1 + below(3);
        for (std::uint32_t p = 0; p < pdo_count; ++p) {
            PdoDescription pdo{static_cast<std::uint16_t>(index + p), false, {}, number};
            const auto entries = huge ? 150u : 1 + below(8);
            for (std::uint32_t e = 0; e < entries; ++e) {
                static constexpr std::array<std::uint8_t, 6> sizes{1, 3, 8, 16, 32, 64};
                const std::uint8_t size = sizes[huge ? 5 : below(6)];
                const bool gap = below(6) == 0;
                pdo.entries.push_back({gap ? std::uint16_t{0} : static_cast<std::uint16_t>(index + 0x1000 + p),
                                       gap ? std::uint8_t{0} : static_cast<std::uint8_t>(e + 1), size});
                bits += size;
            }
            pdos.push_back(pdo);
        }
        const auto bytes = static_cast<std::uint16_t>((bits + 7) / 8);
        const bool adjacent = !s.coe && below(2) == 0;
        s.sync_managers.push_back({use, address, s.coe ? std::uint16_t{0} : bytes, 0});
        address = static_cast<std::uint16_t>(address + (s.coe ? 3 : 1) * bytes + (adjacent ? 0 : 1));
    }

    std::mt19937 random_;
};

struct Bits {
    std::uint64_t first = 0, end = 0;
};
Bits logical_bits(const Fmmu& f) {
    return {std::uint64_t{f.logical_start} * 8 + f.logical_start_bit,
            (std::uint64_t{f.logical_start} + f.length - 1) * 8 + f.logical_stop_bit + 1};
}

/// What a slave adds to the working counter of a logical datagram.
unsigned contribution(const SlavePlan& slave, Command command, std::uint32_t logical, std::size_t size) {
    bool read = false, written = false;
    for (const auto& fmmu : slave.fmmus) {
        const auto bits = logical_bits(fmmu);
        if (bits.first >= (std::uint64_t{logical} + size) * 8 || bits.end <= std::uint64_t{logical} * 8) continue;
        read |= fmmu.read && command != Command::LWR;
        written |= fmmu.write && command != Command::LRD;
    }
    return (read ? 1u : 0u) + (written ? (command == Command::LRW ? 2u : 1u) : 0u);
}

void fmmus_do_not_overlap(const ProcessDataPlan& plan) {
    std::map<std::uint64_t, std::uint64_t> taken;  // first bit -> end
    for (const auto& slave : plan.slaves)
        for (const auto& fmmu : slave.fmmus) {
            const auto bits = logical_bits(fmmu);
            const auto next = taken.lower_bound(bits.first);
            if (next != taken.end()) {
                ASSERT_LE(bits.end, next->first);
            }
            if (next != taken.begin()) {
                ASSERT_LE(std::prev(next)->second, bits.first);
            }
            taken[bits.first] = bits.end;
        }
}

void working_counters_are_what_the_slaves_add(const Bus& bus, const ProcessDataPlan& plan) {
    for (const auto& datagram : plan.datagrams) {
        unsigned sum = 0;
        for (std::size_t s = 0; s < plan.slaves.size(); ++s) {
            const unsigned adds = contribution(plan.slaves[s], datagram.command, datagram.logical, datagram.size());
            sum += adds;
            if (adds > 0) {
                ASSERT_EQ(plan.slaves[s].unit, datagram.unit) << "a datagram reaches the slaves of its unit only";
                ASSERT_TRUE(datagram.command != Command::LRW || bus.slaves[s].lrw);
            }
        }
        ASSERT_EQ(datagram.expected_wkc, sum);
        ASSERT_GT(sum, 0u);
    }
    unsigned full = 0;
    for (const auto& slave : plan.slaves) full += contribution(slave, Command::LRD, plan.mailbox.logical, plan.mailbox.size);
    ASSERT_EQ(plan.mailbox.expected_wkc, full);
}

/// Image bit -> logical bit, through the one datagram that carries it.
std::uint64_t to_logical(const ProcessDataPlan& plan, std::uint64_t image_bit, bool output) {
    std::uint64_t found = 0;
    int carried = 0;
    for (const auto& datagram : plan.datagrams) {
        const auto& range = output ? datagram.outputs : datagram.inputs;
        if (image_bit / 8 < range.offset || image_bit / 8 >= range.offset + range.size) continue;
        ++carried;
        found = (std::uint64_t{datagram.logical} + (output ? 0 : datagram.outputs.size)) * 8 + image_bit - std::uint64_t{range.offset} * 8;
    }
    EXPECT_EQ(carried, 1) << "bit " << image_bit << " of the " << (output ? "outputs" : "inputs");
    return found;
}

/// Logical bit -> physical bit of the slave.
std::optional<std::uint64_t> to_physical(const SlavePlan& slave, std::uint64_t logical, bool output) {
    for (const auto& fmmu : slave.fmmus) {
        const auto bits = logical_bits(fmmu);
        if ((output ? fmmu.write : fmmu.read) && logical >= bits.first && logical < bits.end)
            return std::uint64_t{fmmu.physical_start} * 8 + fmmu.physical_start_bit + logical - bits.first;
    }
    return std::nullopt;
}

/// Where each object lies in the slave, from the PDOs alone: per sync manager one PDO behind the other.
using Place = std::tuple<std::uint16_t, std::uint8_t>;
std::map<Place, std::uint64_t> places_in_slave(const PlanSlave& slave, bool output) {
    std::map<Place, std::uint64_t> places;
    for (std::size_t n = 0; n < slave.sync_managers.size(); ++n) {
        std::uint64_t bit = std::uint64_t{slave.sync_managers[n].start} * 8;
        for (const auto& pdo : output ? slave.rx : slave.tx) {
            if (pdo.sync_manager != n) continue;
            for (const auto& entry : pdo.entries) {
                if (entry.index != 0) places[{entry.index, entry.sub}] = bit;
                bit += entry.bits;
            }
        }
    }
    return places;
}

void every_object_is_found(const Bus& bus, const ProcessDataPlan& plan) {
    for (std::size_t s = 0; s < plan.slaves.size(); ++s)
        for (const bool output : {true, false}) {
            const auto& mapped = output ? plan.slaves[s].mapped_outputs : plan.slaves[s].mapped_inputs;
            const auto places = places_in_slave(bus.slaves[s], output);
            ASSERT_EQ(mapped.size(), places.size());
            for (const auto& entry : mapped)
                for (std::uint32_t bit = 0; bit < entry.bits; bit += std::max(1, entry.bits - 1)) {  // first and last
                    const auto physical = to_physical(plan.slaves[s], to_logical(plan, entry.bit_offset + bit, output), output);
                    ASSERT_TRUE(physical.has_value());
                    ASSERT_EQ(*physical, places.at({entry.index, entry.sub}) + bit);
                }
        }
}

void frames_stay_within_the_ethernet_limit(const ProcessDataPlan& plan) {
    for (std::uint64_t cycle = 0; cycle < 60; ++cycle) {
        FramePacker packer{plan.mailbox};
        std::vector<std::size_t> bytes(max_cyclic_frames, 0);
        bytes[0] = 12 + 8 + 12 + 2 + (plan.mailbox.size > 0 ? 12u + plan.mailbox.size : 0u);
        for (const auto& unit : plan.units) {
            if (!unit.due(cycle)) continue;
            std::size_t before = 0;
            for (std::size_t d = unit.first; d < unit.first + unit.count; ++d) {
                const auto& datagram = plan.datagrams[d];
                ASSERT_LE(datagram.size(), 1486u);
                const auto frame = packer.place(datagram.size(), datagram.continues ? before : 0);
                ASSERT_TRUE(frame.has_value());
                if (datagram.continues) {
                    ASSERT_GE(*frame, before);
                }
                before = *frame;
                bytes[*frame] += datagram.size() + 12;
            }
        }
        ASSERT_LE(packer.frames(), plan.frames);
        for (const auto size : bytes) ASSERT_LE(size, 1498u);
    }
}

void units_are_exchanged_once_a_period(const Bus& bus, const ProcessDataPlan& plan) {
    std::set<std::size_t> in_units;
    for (const auto& unit : plan.units) {
        for (const auto s : unit.slaves) {
            ASSERT_TRUE(in_units.insert(s).second) << "a slave is in one unit";
            ASSERT_EQ(bus.slaves[s].sync_unit, unit.name);
        }
        int due = 0;
        for (std::uint64_t cycle = 0; cycle < 60; ++cycle) due += unit.due(cycle) ? 1 : 0;
        ASSERT_EQ(due, 60 / unit.divisor) << "divisors 1..6 divide 60";
    }
}

TEST(ProcessDataPlanProperty, HoldsForEveryBus) {
    RandomBus random{20261};
    std::size_t planned = 0;
    const std::size_t cases = property_cases(200);
    for (std::size_t i = 0; i < cases; ++i) {
        SCOPED_TRACE("bus " + std::to_string(i));
        const Bus bus = random.next();
        const auto plan = plan_process_data(bus.slaves, bus.units);
        if (!plan) {
            ASSERT_EQ(plan.error().code, "bus.plan.too_many_frames") << plan.error().text();
            continue;
        }
        ++planned;
        fmmus_do_not_overlap(*plan);
        working_counters_are_what_the_slaves_add(bus, *plan);
        every_object_is_found(bus, *plan);
        frames_stay_within_the_ethernet_limit(*plan);
        units_are_exchanged_once_a_period(bus, *plan);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(planned, cases / 2);
}

}  // namespace
}  // namespace taktwerk::ecat
