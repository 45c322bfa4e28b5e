// Random trees with random cables, and clocks that count in ticks: the delays found are the delays there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "ecat/dc/propagation.hpp"
#include "ecat/wire/registers.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat {
namespace {

/// A frame on its way through a tree: what the ports latch, and when it really was at each processing unit.
class LatchingTree {
public:
    LatchingTree(std::mt19937& random, std::size_t slaves, std::int64_t tick, std::int64_t longest_cable = 500)
        : random_(random), tick_(tick) {
        nodes_.resize(slaves);
        for (std::size_t i = 1; i < slaves; ++i) {
            std::size_t parent = pick(0, i - 1);
            while (nodes_[parent].children.size() == 3) parent = pick(0, i - 1);
            nodes_[parent].children.push_back(i);
        }
        for (auto& node : nodes_) {
            node.wire = static_cast<std::int64_t>(pick(0, static_cast<std::size_t>(longest_cable)));  // ns; 500: 100 m
            node.started = static_cast<std::int64_t>(pick(0, 0xFFFF'FFFF));
        }
        walk(0);
    }
    [[nodiscard]] Topology topology() const { return build_topology(dl_status_).value(); }

    std::vector<LatchedTimes> latched;  ///< by position
    std::vector<std::int64_t> there;    ///< by position, ns

private:
    static constexpr std::int64_t processing = 340, forwarding = 300;
    struct Node {
        std::vector<std::size_t> children;
        std::int64_t wire = 0, started = 0;
    };
    std::size_t pick(std::size_t low, std::size_t high) { return std::uniform_int_distribution<std::size_t>{low, high}(random_); }

    void walk(std::size_t n) {
        const std::size_t position = latched.size();
        const Node& node = nodes_[n];
        const auto stamp = [&] { return static_cast<std::uint32_t>((now_ + node.started) / tick_ * tick_); };
        // Children leave through the ports 3, 1, 2 in this order; any of them may be unused.
        std::vector<unsigned> ports{3, 1, 2};
        while (ports.size() > node.children.size()) ports.erase(ports.begin() + static_cast<std::ptrdiff_t>(pick(0, ports.size() - 1)));
        unsigned status = 0x5500;
        for (unsigned p : {0u, 1u, 2u, 3u})
            if (p == 0 || std::find(ports.begin(), ports.end(), p) != ports.end())
                status = (status & ~(1u << (8 + 2 * p))) | (1u << (9 + 2 * p)) | (1u << (4 + p));
        dl_status_.push_back(static_cast<std::uint16_t>(status));
        latched.push_back({.dc = true, .port = {stamp(), 1, 2, 3}, .unit = stamp()});
        there.push_back(now_);
        for (std::size_t i = 0; i < ports.size(); ++i) {
            const Node& child = nodes_[node.children[i]];
            now_ += (i == 0 ? processing : forwarding) + child.wire;
            walk(node.children[i]);
            now_ += (child.children.empty() ? processing : forwarding) + child.wire;
            latched[position].port[ports[i]] = stamp();
        }
    }

    std::mt19937& random_;
    std::int64_t tick_, now_ = 0;
    std::vector<Node> nodes_;
    std::vector<std::uint16_t> dl_status_;
};

TEST(PropagationDelaysOfRandomTrees, AreTheTrueOnesWithClocksThatCountNanoseconds) {
    std::mt19937 random{1};
    for (std::size_t i = 0; i < property_cases(2000); ++i) {
        const LatchingTree tree{random, 1 + i % 40, 1};
        const auto found = propagation_delays(tree.topology(), tree.latched).ns;
        ASSERT_EQ(std::vector<std::int64_t>(found.begin(), found.end()), tree.there) << "case " << i;
    }
}

// A controller counts in 10 ns. A branch is the difference of two stamps (10 ns off at most), halved per slave along the way.
TEST(PropagationDelaysOfRandomTrees, AreOffByLessThanATickAHopWithClocksThatCountTens) {
    std::mt19937 random{2};
    for (std::size_t i = 0; i < property_cases(2000); ++i) {
        const LatchingTree tree{random, 2 + i % 40, 10};
        const auto topology = tree.topology();
        const auto found = propagation_delays(topology, tree.latched).ns;
        for (std::size_t p = 0; p < found.size(); ++p) {
            const auto off = std::abs(static_cast<std::int64_t>(found[p]) - tree.there[p]);
            ASSERT_LE(off, 15 * static_cast<std::int64_t>(topology.slaves[p].depth)) << "case " << i << ", position " << p;
        }
    }
}

// Every third slave has no clock, all hops are alike: what stands between clocks is shared out right, however it branches.
TEST(PropagationDelaysOfRandomTrees, ShareOutEqualHopsBetweenClocks) {
    std::mt19937 random{3};
    for (std::size_t i = 0; i < property_cases(2000); ++i) {
        LatchingTree tree{random, 2 + i % 40, 1, 0};
        for (std::size_t p = 1; p < tree.latched.size(); p += 3) tree.latched[p] = {};
        const auto found = propagation_delays(tree.topology(), tree.latched).ns;
        for (std::size_t p = 0; p < found.size(); ++p) {
            if (!tree.latched[p].dc) continue;
            ASSERT_EQ(found[p], tree.there[p]) << "case " << i << ", position " << p;
        }
    }
}

}  // namespace
}  // namespace taktwerk::ecat
