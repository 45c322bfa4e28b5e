#pragma once
// Blocks on several real axes over fake drives, in virtual time: axis 0 leads, axis 1 follows. One u is 1000 counts; linear, roomy limits,
// infinite jerk.

#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "axes/axis/plan_order.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {

class CoupledPlc {
public:
    static constexpr Duration period = 1ms;
    static constexpr AxisRef master{0}, slave{1};

    /// `declared`: tables that axes take room for when they are bound, those over time.
    explicit CoupledPlc(std::size_t count = 2, axes::MotionTables declared = {}, const axes::AxisConfig& config = Plc::roomy_axis())
        : tables(std::move(declared)) {
        axes_.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            drives_.emplace_back(period);
            axes_.emplace_back(config, drives_.back(), period, static_cast<std::uint16_t>(i));
            oracles_.emplace_back(config, period);
        }
        for (auto& axis : axes_) axis.bind({axes_.data(), axes_.size(), &tables, {}});
        requests_ = axes::DirectRequests{axes_};
        powers_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            powers_[i].Axis = {static_cast<std::uint16_t>(i)};
            powers_[i].Enable = true;
        }
        run_until([this] { return powers_.back().Status; }, 1s);
    }
    CoupledPlc(const CoupledPlc&) = delete;
    CoupledPlc& operator=(const CoupledPlc&) = delete;
    /// Whatever a test is about: what must always hold held.
    ~CoupledPlc() {
        bool looked = false;
        for (const auto& oracle : oracles_) {
            EXPECT_TRUE(oracle.clean()) << oracle.report();
            looked = looked || oracle.compared() > 0;
        }
        EXPECT_TRUE(looked) << "no oracle compared a motion";
    }

    void scan() {
        now_ += period;
        for (auto& axis : axes_) {
            axis.update(now_);
            axis.supervise(now_);
        }
        seen_.clear();
        for (const auto& axis : axes_) seen_.push_back(axis.view());
        MotionContext ctx;
        ctx.now = now_;
        ctx.period = period;
        ctx.cycle = ++cycle_;
        ctx.axes = seen_;
        ctx.requests = &requests_;
        ctx.tables = &tables;
        for (auto& power : powers_) power(ctx);
        if (program) program(ctx);
        axes::plan_axes(axes_, now_, period);
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            axes_[i].encode(now_);
            oracles_[i].observe(axes_[i].view(), axes_[i].drive_command(), axes_[i].config().limits);
        }
    }
    Duration run_until(const std::function<bool()>& condition, Duration most) {
        Duration t{};
        for (; t <= most && !condition(); t += period) scan();
        return t;
    }
    void run_for(Duration time) {
        for (Duration t{}; t < time; t += period) scan();
    }
    const axes::AxisView& view(AxisRef axis) const { return axes_[axis.index].view(); }
    double position(AxisRef axis) const { return view(axis).set_position; }
    double velocity(AxisRef axis) const { return view(axis).set_velocity; }

    axes::MotionTables tables;
    std::function<void(const MotionContext&)> program;

private:
    std::deque<axes::test::FakeDrive> drives_;
    std::vector<axes::Axis> axes_;
    std::vector<axes::test::MotionOracle> oracles_;
    std::vector<axes::AxisView> seen_;
    std::vector<MC_Power> powers_;
    axes::DirectRequests requests_;
    Instant now_{};
    std::uint64_t cycle_ = 0;
};

}  // namespace taktwerk::fb
