#include "ecat/dc/propagation.hpp"

#include <algorithm>

namespace taktwerk::ecat {

namespace {

/// Times between the arrivals at the open ports of one slave, one a branch, in the order in which the frame took them.
std::vector<std::int64_t> branch_times(const SlavePlace& place, const LatchedTimes& times) {
    std::vector<std::uint32_t> stamps;
    for (unsigned port = 0; port < ports_per_slave; ++port)
        if (place.open[port]) stamps.push_back(times.port[port]);
    // The clock may wrap between two of them. The first is the one that all others lie behind.
    const auto is_first = [&](std::uint32_t t) {
        return std::all_of(stamps.begin(), stamps.end(), [&](std::uint32_t other) { return other - t < 0x8000'0000u; });
    };
    const auto found = std::find_if(stamps.begin(), stamps.end(), is_first);
    const std::uint32_t first = found == stamps.end() ? 0 : *found;
    std::sort(stamps.begin(), stamps.end(), [&](std::uint32_t a, std::uint32_t b) { return a - first < b - first; });
    std::vector<std::int64_t> result;
    for (std::size_t i = 1; i < stamps.size(); ++i) result.push_back(stamps[i] - stamps[i - 1]);
    return result;
}

/// Follows the frame through the tree.
class Walk {
public:
    Walk(const Topology& topology, std::span<const LatchedTimes> slaves)
        : topology_(topology), slaves_(slaves), times_(slaves.size()), at_(slaves.size(), 0) {
        for (std::size_t p = 0; p < slaves.size(); ++p)
            if (slaves[p].dc) times_[p] = branch_times(topology.slaves[p], slaves[p]);
        result_.ns.assign(slaves.size(), 0);
    }

    PropagationDelays run() {
        const auto first = std::find_if(slaves_.begin(), slaves_.end(), [](const LatchedTimes& t) { return t.dc; });
        if (first == slaves_.end()) return std::move(result_);
        const auto reference = static_cast<std::size_t>(first - slaves_.begin());
        hop_ = Fraction{assumed_hop.count() - processing_difference.count(), 1};
        enter(0);
        const std::int64_t origin = at_[reference];
        const auto measured = topology_.behind(reference);
        for (std::size_t p = 0; p < slaves_.size(); ++p) {
            if (!slaves_[p].dc) continue;
            result_.ns[p] = static_cast<std::uint32_t>(std::max<std::int64_t>(at_[p] - origin, 0));
            if (std::find(measured.begin(), measured.end(), p) == measured.end()) result_.estimated.push_back(p);
        }
        return std::move(result_);
    }

private:
    /// ns, exact while hops are added up.
    struct Fraction {
        std::int64_t numerator = 0, denominator = 1;
    };
    struct Part {
        std::int64_t known = 0;  ///< ns that clocks behind account for
        std::int64_t hops = 0, through_unit = 0;
    };

    [[nodiscard]] bool leaf(std::size_t p) const { return children(p).empty(); }
    [[nodiscard]] std::vector<std::size_t> children(std::size_t p) const {
        std::vector<std::size_t> result;
        for (const auto& child : topology_.slaves[p].child)
            if (child) result.push_back(*child);
        std::sort(result.begin(), result.end());
        return result;
    }

    /// What lies between the clocks of the branch that begins with `p`, both ways, without its first hop's own start.
    [[nodiscard]] Part between(std::size_t p) const {
        Part part{0, 2, leaf(p) ? 1 : 0};
        if (slaves_[p].dc) {
            for (const std::int64_t t : times_[p]) part.known += t;
            return part;
        }
        const auto branches = children(p);
        for (std::size_t i = 0; i < branches.size(); ++i) {
            const Part more = between(branches[i]);
            part.known += more.known;
            part.hops += more.hops;
            part.through_unit += more.through_unit + (i == 0 ? 1 : 0);
        }
        return part;
    }

    void add_hop(bool through_unit) {
        now_ += through_unit ? processing_difference.count() : 0;
        rest_ += hop_.numerator;
        now_ += rest_ / hop_.denominator;
        rest_ %= hop_.denominator;
    }

    /// The frame is at the processing unit of `p`.
    void enter(std::size_t p) {
        at_[p] = now_ + (2 * rest_ >= hop_.denominator ? 1 : 0);
        const auto branches = children(p);
        const bool clock = slaves_[p].dc;
        const Fraction outer = hop_;
        const std::int64_t outer_rest = rest_, arrived = now_;
        std::int64_t left = 0;  // when the branch began, by this slave's clock
        for (std::size_t i = 0; i < branches.size(); ++i) {
            if (clock && i < times_[p].size()) {
                const Part part = between(branches[i]);
                const std::int64_t through = part.through_unit + (i == 0 ? 1 : 0);
                // Quantised clocks of two slaves can make a short cable look negative.
                hop_ = Fraction{std::max<std::int64_t>(times_[p][i] - part.known - through * processing_difference.count(), 0), part.hops};
                now_ = arrived + left;
                rest_ = 0;
                left += times_[p][i];
            }
            add_hop(i == 0);
            enter(branches[i]);
            add_hop(leaf(branches[i]));
        }
        if (!clock) return;
        now_ = arrived + left;
        hop_ = outer;
        rest_ = outer_rest;
    }

    const Topology& topology_;
    std::span<const LatchedTimes> slaves_;
    std::vector<std::vector<std::int64_t>> times_;
    std::vector<std::int64_t> at_;  ///< by position: when the frame was at the processing unit; the start is 0
    PropagationDelays result_;
    Fraction hop_;
    std::int64_t now_ = 0, rest_ = 0;  ///< ns, and the numerator of the part of a ns
};

}  // namespace

PropagationDelays propagation_delays(const Topology& topology, std::span<const LatchedTimes> slaves) {
    return Walk{topology, slaves}.run();
}

std::uint64_t sync0_start(std::uint64_t now, Duration margin, Duration cycle, Duration phase, Duration shift) noexcept {
    const std::int64_t origin = (phase + shift).count();
    const std::int64_t earliest = static_cast<std::int64_t>(now) + margin.count();
    const std::int64_t period = cycle.count();
    return static_cast<std::uint64_t>(next_sync0(earliest, origin, period));
}

}  // namespace taktwerk::ecat
