#pragma once
// The cyclic half of the master: process data, reference time, AL states and a few acyclic datagrams in each cycle. After
// adopt() nothing here allocates; receive(), send() and pump() are real-time safe and belong to one thread.

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ecat/bus_config.hpp"
#include "ecat/cycle/bus_health.hpp"
#include "ecat/cycle/bus_phase.hpp"
#include "ecat/cycle/cycle_clock.hpp"
#include "ecat/cycle/cycle_link.hpp"
#include "ecat/cycle/cycle_plan.hpp"
#include "ecat/cycle/upheavals.hpp"
#include "ecat/exchange/acyclic_channel.hpp"
#include "ecat/exchange/exchange.hpp"
#include "ecat/layout/frame_schedule.hpp"

namespace taktwerk::ecat {

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
    [[nodiscard]] Attendance attendance(std::size_t slave) const noexcept;
    /// What is wrong with a bus in this phase; of one in OP as of the last receive().
    [[nodiscard]] std::span<const AlarmFact> faults(BusPhase phase) const noexcept;
    [[nodiscard]] const BusStatistics& statistics() const noexcept { return statistics_; }
    [[nodiscard]] Instant outputs_effective(std::size_t slave, Instant send_time) const noexcept;
    [[nodiscard]] Duration period_correction() const noexcept { return clock_.correction(); }
    void set_tap(Exchange::Tap tap, void* context) noexcept { exchange_.set_tap(tap, context); }

private:
    void collect_frames(CyclePlan& cycle) noexcept;
    void collect_first_frame(CyclePlan& cycle, SlotId slot) noexcept;
    void measure_margin(CyclePlan& cycle, SlotId slot) noexcept;
    /// All datagrams of the unit or nothing.
    void take_unit(CyclePlan& cycle, const UnitPlan& unit) noexcept;
    /// Of a group that is not there: its datagrams go round, and nobody is expected to answer them.
    [[nodiscard]] static bool away(const CyclePlan& cycle, const UnitPlan& unit) noexcept;
    [[nodiscard]] bool answered_exactly(const CyclePlan& cycle, const UnitPlan& unit) noexcept;
    void send_frames(CyclePlan& cycle, Instant now) noexcept;
    void pack_bring_up(Instant now) noexcept;
    void add_clock(const CyclePlan& cycle, SlotId slot, Instant now) noexcept;
    void add_unit(CyclePlan& cycle, const UnitPlan& unit, FramePacker& packer) noexcept;
    void give_up_frames(CyclePlan& cycle) noexcept;
    void find_faults(CyclePlan& cycle, Instant now) noexcept;
    void note_stall(Instant now) noexcept;
    void note_gap(Instant now) noexcept;
    void steer_ring(const CyclePlan& cycle) noexcept;
    /// SYNC0 of the slave, as machine time follows from it; 0: does not run, or the reference is not known yet.
    [[nodiscard]] std::int64_t sync0_of(const CyclePlan& cycle, std::size_t slave) const noexcept;
    void copy_statistics() noexcept;

    Transport& transport_;
    RingView* ring_;  ///< nullptr: one interface
    const BusConfig& config_;
    Exchange exchange_;
    AcyclicChannel channel_;
    CycleClock clock_;
    std::vector<std::unique_ptr<CyclePlan>> plans_;  ///< service side owns; the cycle sees the two pointers below
    std::atomic<CyclePlan*> running_{nullptr};
    std::atomic<CyclePlan*> latest_{nullptr};
    std::atomic<CycleLink*> link_{nullptr};
    std::atomic<bool> operational_{false};
    BusStatistics statistics_;
    SlaveHealth nothing_;

    // Of the cycle.
    std::int64_t clock_offset_ = 0;  // reference clock minus machine time when the present answers were sent; ns
    struct {
        Instant send_time = Instant::min();
        std::int64_t offset = 0;
    } mutable next_send_;                    // the same when the next frames leave: asked for by every axis
    std::optional<Instant> last_departure_;  // of process data
    Upheavals upheavals_;
    bool all_good_ = true;
    bool any_lost_ = false;
    bool margin_known_ = false;
};

}  // namespace taktwerk::ecat
