#pragma once
// What the benchmark and the count of instructions move: axes on virtual drives, so that the figures are axis, blocks and planner.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "axes/axis/direct_requests.hpp"
#include "axes/axis/plan_order.hpp"
#include "axes/sim/virtual_drive.hpp"
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/power.hpp"
#include "fb_library/motion/reading.hpp"

namespace taktwerk::bench {

using namespace taktwerk::fb;
using namespace std::chrono_literals;

inline constexpr Duration period = 1ms;

inline axes::AxisConfig shuttle_axis() {
    axes::AxisConfig config;
    config.name = std::string{"x"};  // g++ 12 -Wrestrict takes an assignment of the literal for an overlap
    config.gearing = {.counts_per_revolution = 10000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 10};
    config.limits = {.velocity = 400, .acceleration = 500, .deceleration = 500, .jerk = 5000};
    config.require_homed = false;
    return config;
}

/// The cycle of DESIGN.md section 3 without a bus.
class Shuttles {
public:
    explicit Shuttles(std::size_t count) : blocks_(count) {
        axes_.reserve(count);
        views_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            drives_.push_back(std::make_unique<axes::sim::VirtualDrive>(period));
            axes_.emplace_back(shuttle_axis(), *drives_.back(), period, static_cast<std::uint16_t>(i), &views_[i]);
            auto& b = blocks_[i];
            b.power.Axis = b.move.Axis = b.status.Axis = axes::AxisRef{static_cast<std::uint16_t>(i)};
            b.power.Enable = b.status.Enable = true;
            b.move.Velocity = 400;
            b.move.Acceleration = b.move.Deceleration = 500;
            b.move.Jerk = 5000;
        }
        requests_ = axes::DirectRequests{axes_};
        // Not all of them turn in the same cycle.
        for (std::size_t i = 0; i < 100 + 7 * count; ++i) cycle(i / 7);
    }

    /// One cycle of the first `moving` axes' programs and of all axes.
    void cycle(std::size_t moving) noexcept {
        now_ += period;
        for (auto& axis : axes_) axis.update(now_);
        for (auto& axis : axes_) axis.supervise(now_);
        MotionContext ctx;
        ctx.now = now_;
        ctx.period = period;
        ctx.cycle = ++cycles_;
        ctx.axes = views_;
        ctx.requests = &requests_;
        for (std::size_t i = 0; i < blocks_.size(); ++i) {
            auto& b = blocks_[i];
            b.power(ctx);
            b.status(ctx);
            if (i >= moving || !b.power.Status) continue;
            if (b.move.Done || command_all) {
                b.move.Execute = false;
                b.move(ctx);
                b.move.Position = b.move.Position > 250 ? 0 : 500;
            }
            b.move.Execute = true;
            b.move(ctx);
        }
        command_all = false;
        axes::plan_axes(axes_, now_, period);
        for (auto& axis : axes_) axis.encode(now_);
    }
    [[nodiscard]] std::size_t in_motion() const noexcept {
        return static_cast<std::size_t>(
            std::count_if(axes_.begin(), axes_.end(), [](const auto& a) { return a.view().set_velocity != 0; }));
    }

    bool command_all = false;

private:
    struct Blocks {
        MC_Power power;
        MC_MoveAbsolute move;
        MC_ReadStatus status;
    };
    std::vector<std::unique_ptr<axes::sim::VirtualDrive>> drives_;
    std::vector<axes::Axis> axes_;
    std::vector<axes::AxisView> views_;
    axes::DirectRequests requests_;
    std::vector<Blocks> blocks_;
    Instant now_{};
    std::uint64_t cycles_ = 0;
};

/// A master at 100 u/s and `count` axes after it, each with the same command.
class Followers {
public:
    explicit Followers(std::size_t count) {
        std::vector<axes::CamPoint> points;
        for (int i = 0; i <= 100; ++i)  // a stroke of 20 u and back over 100 u of the master
            points.push_back({1.0 * i, 20.0 * (i <= 50 ? i : 100 - i) / 50.0, 0, 0, axes::CamSegment::spline});
        cam_ = tables_.add_cam(points);
        axes_.reserve(count + 1);
        for (std::size_t i = 0; i <= count; ++i) {
            drives_.push_back(std::make_unique<axes::sim::VirtualDrive>(period));
            axes_.emplace_back(shuttle_axis(), *drives_.back(), period, static_cast<std::uint16_t>(i));
        }
        for (auto& axis : axes_) axis.bind({axes_.data(), axes_.size(), &tables_, {}});
        for (int i = 0; i < 100; ++i) cycle();
    }
    void cycle() noexcept {
        now_ += period;
        for (auto& axis : axes_) {
            axis.update(now_);
            axis.supervise(now_);
            axis.power(true, true, true, axes::Owner::program);
        }
        axes::plan_axes(axes_, now_, period);
        for (auto& axis : axes_) axis.encode(now_);
    }
    void run_master() { submit(0, {.kind = axes::CommandKind::move_velocity, .velocity = 100}); }
    void gear() { for_slaves({.kind = axes::CommandKind::gear_in, .details = axes::GearDetails{axes::AxisRef{0}, {1, 2}, mcSetValue}}); }
    void cam() {
        const auto id = tables_.prepare(cam_, true, false, false).id;
        for_slaves(
            {.kind = axes::CommandKind::cam_in, .details = axes::CamDetails{.master = axes::AxisRef{0}, .table = id, .start = mcRelative}});
    }
    void superimpose() { for_slaves({.kind = axes::CommandKind::move_superimposed, .position = 1e6, .velocity = 1}); }
    void run_all() { for_slaves({.kind = axes::CommandKind::move_velocity, .velocity = 100}); }

private:
    void submit(std::size_t axis, const axes::AxisCommand& command) {
        if (const auto answer = axes_[axis].submit(command, axes::Owner::program); answer.error != ErrorId::none) {
            fmt::print(stderr, "axis {} refuses: {}\n", axis, static_cast<int>(answer.error));
            std::exit(1);
        }
    }
    void for_slaves(const axes::AxisCommand& command) {
        for (std::size_t i = 1; i < axes_.size(); ++i) submit(i, command);
        for (int i = 0; i < 2000; ++i) cycle();
    }

    axes::MotionTables tables_;
    axes::CamRef cam_;
    std::vector<std::unique_ptr<axes::sim::VirtualDrive>> drives_;
    std::vector<axes::Axis> axes_;
    Instant now_{};
};

}  // namespace taktwerk::bench
