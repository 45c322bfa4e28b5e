#include "ecat/layout/frame_schedule.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "ecat/dc/sync0_budget.hpp"

namespace taktwerk::ecat {

namespace {

/// FRMW of the system time and BRD of the AL status, in the first frame.
constexpr std::size_t clock_datagram = datagram_overhead + 8;
constexpr std::size_t state_datagram = datagram_overhead + 2;
/// Cycles over which the load is compared; longer patterns repeat nearly enough.
constexpr std::size_t longest_horizon = 4096;

std::size_t bytes_of(const ProcessDataPlan& plan, const UnitPlan& unit) {
    std::size_t bytes = 0;
    for (std::size_t d = unit.first; d < unit.first + unit.count; ++d) bytes += plan.datagrams[d].size() + datagram_overhead;
    return bytes;
}

/// After so many cycles the pattern of due units begins again.
std::size_t horizon_of(const ProcessDataPlan& plan) {
    std::size_t horizon = 1;
    for (const auto& unit : plan.units) horizon = std::min(longest_horizon, std::lcm(horizon, std::size_t{unit.divisor}));
    return horizon;
}

template <class Due>
std::optional<std::size_t> pack(const ProcessDataPlan& plan, Due due) noexcept {
    FramePacker packer{plan.mailbox};
    for (const auto& unit : plan.units) {
        if (!due(unit)) continue;
        std::size_t before = 0;
        for (std::size_t d = unit.first; d < unit.first + unit.count; ++d) {
            const auto frame = packer.place(plan.datagrams[d].size(), plan.datagrams[d].continues ? before : 0);
            if (!frame) return std::nullopt;
            before = *frame;
        }
    }
    return packer.frames();
}

}  // namespace

std::size_t FramePacker::room_in_first(const MailboxStatusPlan& mailbox) noexcept {
    const std::size_t mailbox_datagram = mailbox.size > 0 ? datagram_overhead + mailbox.size : 0;
    const std::size_t taken = clock_datagram + state_datagram + mailbox_datagram + datagram_overhead;
    return taken < frame_capacity ? frame_capacity - taken : 0;
}

FramePacker::FramePacker(const MailboxStatusPlan& mailbox) noexcept {
    room_.fill(static_cast<std::uint16_t>(frame_capacity));
    room_[0] = static_cast<std::uint16_t>(room_in_first(mailbox) + datagram_overhead);
}

std::optional<std::size_t> FramePacker::place(std::size_t data_size, std::size_t from) noexcept {
    const std::size_t size = data_size + datagram_overhead;
    while (open_ < frames_ && room_[open_] <= datagram_overhead) ++open_;
    for (std::size_t f = std::max(from, open_); f < max_cyclic_frames; ++f) {
        if (size > room_[f]) continue;
        room_[f] = static_cast<std::uint16_t>(room_[f] - size);
        frames_ = std::max(frames_, f + 1);
        return f;
    }
    return std::nullopt;
}

void stagger(ProcessDataPlan& plan) {
    const std::size_t horizon = horizon_of(plan);
    std::vector<std::size_t> load(horizon, 0), order(plan.units.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {  // large ones first: small ones fill what is left
        return bytes_of(plan, plan.units[a]) > bytes_of(plan, plan.units[b]);
    });
    for (const std::size_t u : order) {
        auto& unit = plan.units[u];
        const auto fullest = [&](std::size_t phase) {
            std::size_t most = 0;
            for (std::size_t n = phase; n < horizon; n += unit.divisor) most = std::max(most, load[n]);
            return most;
        };
        std::size_t best = 0;
        for (std::size_t phase = 1; phase < std::min<std::size_t>(unit.divisor, horizon); ++phase)
            if (fullest(phase) < fullest(best)) best = phase;
        unit.phase = static_cast<std::uint16_t>(best);
        for (std::size_t n = best; n < horizon; n += unit.divisor) load[n] += bytes_of(plan, unit);
    }
}

std::size_t frames_in_cycle(const ProcessDataPlan& plan, std::uint64_t cycle) noexcept {
    return pack(plan, [&](const UnitPlan& unit) { return unit.due(cycle); }).value_or(max_cyclic_frames);
}

CycleLoad fullest_cycle(const ProcessDataPlan& plan) {
    constexpr std::size_t headers = ethernet_header_size + ecat_header_size;
    const std::size_t mailbox = plan.mailbox.size > 0 ? datagram_overhead + plan.mailbox.size : 0;
    CycleLoad most;
    for (std::size_t n = 0; n < horizon_of(plan); ++n) {
        CycleLoad load{clock_datagram + state_datagram + mailbox, frames_in_cycle(plan, n), {}};
        for (const auto& unit : plan.units)
            if (unit.due(n)) load.bytes += bytes_of(plan, unit);
        load.bytes = std::max(load.bytes + load.frames * headers, load.frames * min_frame_size);
        load.wire = flight_time(load.bytes, load.frames, 0);
        if (load.wire > most.wire) most = load;
    }
    return most;
}

std::optional<std::size_t> frames_at_most(const ProcessDataPlan& plan) noexcept {
    return pack(plan, [](const UnitPlan&) { return true; });
}

}  // namespace taktwerk::ecat
