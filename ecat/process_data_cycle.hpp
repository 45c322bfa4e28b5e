#pragma once
// The cyclic half of the master: process data, reference time, AL states and a few acyclic datagrams in each cycle. After
// adopt() nothing here allocates; receive(), send() and pump() are real-time safe and belong to one thread.

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ecat/bringup/bus.hpp"
#include "ecat/dc/reference_clock.hpp"
#include "ecat/exchange/acyclic_channel.hpp"
#include "ecat/exchange/exchange.hpp"
#include "ecat/master.hpp"

namespace taktwerk::ecat {

/// A plan as the cycle runs it: made by the service side, published once, kept until the master dies.
struct CyclePlan {
    explicit CyclePlan(const Bus& bus);

    ProcessDataPlan plan;
    std::vector<const BusSlave*> slaves;
    std::optional<std::uint16_t> reference;  ///< station of the reference clock
    std::uint16_t clock_wkc = 0, state_wkc = 0;
    // Working area of the cycle.
    std::vector<std::byte> outputs, inputs;
    std::vector<SlaveHealth> health;
    std::vector<SlotId> in_flight;            ///< one a frame; generation 0: none
    std::vector<std::size_t> first_datagram;  ///< of frame f; one more at the end
};

class ProcessDataCycle {
public:
    ProcessDataCycle(Transport& transport, const BusConfig& config);

    // --- service side ---------------------------------------------------------------------------------------------------
    void connect(CycleLink& link) noexcept { link_.store(&link); }
    void adopt(std::unique_ptr<CyclePlan> plan);
    /// The cycle sends no more process data; images and health stay readable.
    void withdraw() noexcept { running_.store(nullptr); }
    void set_operational(bool operational) noexcept { operational_.store(operational); }
    [[nodiscard]] AcyclicChannel& channel() noexcept { return channel_; }
    [[nodiscard]] bool published() const noexcept { return latest_.load() != nullptr; }

    // --- cyclic side ----------------------------------------------------------------------------------------------------
    void pump(Instant now) noexcept;
    void receive(Instant now) noexcept;
    void send(Instant now) noexcept;
    [[nodiscard]] std::span<const std::byte> inputs() const noexcept;
    [[nodiscard]] std::span<std::byte> outputs() noexcept;
    [[nodiscard]] const SlaveHealth& health(std::size_t slave) const noexcept;
    [[nodiscard]] const BusStatistics& statistics() const noexcept { return statistics_; }
    [[nodiscard]] Instant outputs_effective(std::size_t slave, Instant send_time) const noexcept;
    [[nodiscard]] bool link_up() const noexcept { return transport_.link_up(); }
    void set_tap(Exchange::Tap tap, void* context) noexcept { exchange_.set_tap(tap, context); }

private:
    /// Datagrams of one frame, in order, after [clock] in the first.
    void collect_frames(CyclePlan& cycle, Instant now) noexcept;
    void take_datagram(CyclePlan& cycle, std::size_t datagram, SlotId slot, std::size_t number) noexcept;
    void take_clock(const CyclePlan& cycle, SlotId slot) noexcept;
    void miss(CyclePlan& cycle, const DatagramPlan& datagram) noexcept;
    void send_frame(CyclePlan& cycle, std::size_t frame, Instant now) noexcept;
    void update_phase(Instant now) noexcept;
    void copy_statistics() noexcept;

    Transport& transport_;
    const BusConfig& config_;
    Exchange exchange_;
    AcyclicChannel channel_;
    std::vector<std::unique_ptr<CyclePlan>> plans_;  ///< service side owns; the cycle sees the two pointers below
    std::atomic<CyclePlan*> running_{nullptr};
    std::atomic<CyclePlan*> latest_{nullptr};
    std::atomic<CycleLink*> link_{nullptr};
    std::atomic<bool> operational_{false};
    BusStatistics statistics_;
    SlaveHealth nothing_;

    // Of the cycle.
    bool all_good_ = true;
    bool any_lost_ = false;
    ReferenceClock clock_;
    std::optional<std::int64_t> phase_;
};

}  // namespace taktwerk::ecat
