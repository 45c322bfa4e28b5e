// Any tree of simulated slaves looks, through its registers, like the tree that was built. The generator is seeded.

#include <gtest/gtest.h>

#include <random>

#include "ecat/sim/digital_terminal.hpp"
#include "ecat/topology/topology.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

struct Grown {
    SimSlave* slave = nullptr;
    const SimSlave* parent = nullptr;
    unsigned port = 0;
    std::int64_t cable_ns = 0;
};

/// 1..`most` slaves, each behind a free port of any of those before it.
std::vector<Grown> grow(BusProbe& bus, std::mt19937& random, std::size_t most) {
    const auto device = std::make_shared<const DeviceDescription>([] {
        auto description = digital_input_output_terminal(8, 8);
        description.dc.supported = true;
        return description;
    }());
    std::vector<Grown> grown;
    grown.push_back({&bus.network.add(device, std::make_unique<DigitalTerminal>()), nullptr, 0, 50});
    const std::size_t size = 1 + random() % most;
    while (grown.size() < size) {
        const auto& parent = grown[random() % grown.size()];
        const auto port = static_cast<unsigned>(1 + random() % 3);
        if (!bus.network.port_free(*parent.slave, port)) continue;
        auto& slave = bus.network.add_behind(*parent.slave, port, device, std::make_unique<DigitalTerminal>(),
                                             {.clock_start = Duration{static_cast<std::int64_t>(random())}});
        const auto cable = static_cast<std::int64_t>(random() % 500);
        bus.network.set_cable_delay(slave, Duration{cable});
        grown.push_back({&slave, parent.slave, port, cable});
    }
    return grown;
}

std::vector<std::uint16_t> read_dl_status(BusProbe& bus) {
    std::vector<std::uint16_t> status;
    const auto count = bus.send(Command::BRD, Address::physical(0, 0), Bytes(1)).wkc;
    for (std::uint16_t i = 0; i < count; ++i) status.push_back(bus.value<std::uint16_t>(i, reg::dl_status));
    return status;
}

TEST(RandomTrees, DlStatusGivesBackTheTreeThatWasBuilt) {
    std::mt19937 random{20261121};
    for (int round = 0; round < 300; ++round) {
        BusProbe bus;
        const auto grown = grow(bus, random, 24);

        const auto tree = build_topology(read_dl_status(bus));

        ASSERT_TRUE(tree) << tree.error().text();
        ASSERT_EQ(tree->slaves.size(), grown.size());
        for (const auto& g : grown) {
            const auto& place = tree->slaves[bus.network.position(*g.slave)];
            EXPECT_EQ(place.entry_port, 0u);
            ASSERT_EQ(place.parent.has_value(), g.parent != nullptr);
            if (g.parent == nullptr) continue;
            EXPECT_EQ(*place.parent, bus.network.position(*g.parent));
            EXPECT_EQ(place.parent_port, g.port);
        }
    }
}

TEST(RandomTrees, APulledCableTakesAwayExactlyWhatTheTopologySaysIsBehindIt) {
    std::mt19937 random{7};
    for (int round = 0; round < 200; ++round) {
        BusProbe bus;
        const auto grown = grow(bus, random, 16);
        const auto whole = build_topology(read_dl_status(bus));
        ASSERT_TRUE(whole);
        const std::size_t victim = random() % grown.size();

        bus.network.set_cable(victim, false);
        const auto status = read_dl_status(bus);

        EXPECT_EQ(status.size(), grown.size() - whole->behind(victim).size());
        EXPECT_TRUE(build_topology(status));
        bus.network.set_cable(victim, true);
        EXPECT_EQ(read_dl_status(bus).size(), grown.size());
    }
}

// What a frame needs out of a port and back is what the receive times of that port and the one before it in the ring differ by,
// whatever the tree: the cable both ways and the time of the branch behind. The branch's own receive times say how long that is.
TEST(RandomTrees, ReceiveTimesAddUpAlongEveryCable) {
    std::mt19937 random{99};
    for (int round = 0; round < 100; ++round) {
        BusProbe bus;
        const auto grown = grow(bus, random, 16);
        bus.wait(1ms);
        bus.send(Command::BWR, Address::physical(0, reg::dc_receive_times), Bytes(4));
        const auto tree = build_topology(read_dl_status(bus));
        ASSERT_TRUE(tree);
        std::vector<std::array<std::uint32_t, 4>> times(grown.size());
        for (std::uint16_t i = 0; i < static_cast<std::uint16_t>(grown.size()); ++i)
            for (std::uint16_t p = 0; p < 4; ++p)
                times[i][p] = bus.value<std::uint32_t>(i, static_cast<std::uint16_t>(reg::dc_receive_times + 4 * p));

        for (const auto& g : grown) {
            if (g.parent == nullptr) continue;
            const auto parent = bus.network.position(*g.parent), child = bus.network.position(*g.slave);
            const auto& above = tree->slaves[parent];
            unsigned before = 0;  // the open port from which the frame came to this one
            for (const unsigned p : above.exits()) {
                if (p == g.port) break;
                before = p;
            }
            const auto& below = tree->slaves[child];
            const unsigned last = below.exits().empty() ? 0 : below.exits().back();
            // Inside the parent 600 ns through its unit (from port 0) or 560; inside the child back to port 0 the same way.
            const std::uint32_t inside_parent = before == 0 ? 600 : 560, inside_child = last == 0 ? 600 : 560;
            const std::uint32_t in_child = times[child][last] - times[child][0] + inside_child;
            EXPECT_EQ(times[parent][g.port] - times[parent][before], inside_parent + 2 * static_cast<std::uint32_t>(g.cable_ns) + in_child);
        }
    }
}

}  // namespace
}  // namespace taktwerk::ecat::sim
