#pragma once
// Real axes over fake drives in virtual time, for pictures: scans as a base task runs them, every one noted.

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "axes/axis/axis.hpp"
#include "axes/axis/direct_requests.hpp"
#include "axes/axis/motion_context.hpp"
#include "fb_library/motion/power.hpp"
#include "fb_library/motion/stops.hpp"
#include "tests/axes/axis/fake_drive.hpp"
#include "tests/axes/axis/motion_oracle.hpp"
#include "tests/motion_figures/figure.hpp"

namespace taktwerk::figures {

using namespace std::chrono_literals;

/// Counts of the fake drive.
inline constexpr std::int64_t mm = 10'000;

/// What a picture shows of an axis.
enum class Quantity { position, velocity, acceleration, actual_position, actual_velocity, actual_torque, given_torque };

class Stage {
public:
    static constexpr Duration period = 1ms;

    /// mm; 200 mm/s, 1000 mm/s2, 20000 mm/s3.
    static axes::AxisConfig linear(const std::string& name = "x");

    /// Powers the axes; what follows is noted.
    explicit Stage(const std::vector<axes::AxisConfig>& configs = {linear()});
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    static constexpr axes::AxisRef ref(std::uint16_t index = 0) { return {index}; }
    [[nodiscard]] const axes::AxisView& view(std::uint16_t index = 0) const { return axes_[index].view(); }
    /// Before the first scan.
    axes::CamRef cam(const std::vector<axes::CamPoint>& points) { return tables_.add_cam(points); }
    axes::TimeTableRef time_table(const std::vector<axes::TimePoint>& rows);
    axes::CamSwitchRef cam_switches(const std::vector<axes::CamSwitch>& switches) { return tables_.add_cam_switches(switches); }
    axes::TrackRef tracks(const std::vector<axes::TrackOptions>& options) { return tables_.add_tracks(options); }
    [[nodiscard]] axes::test::FakeDrive& drive(std::uint16_t index = 0) { return drives_[index]; }

    /// Shows `value` as a bar, in the colour of the block named last.
    void bar(const std::string& label, const bool& value);
    /// What belongs to no block: a switch, a track.
    void signal(const std::string& label, std::function<bool()> value) { bars_.push_back({label, -1, std::move(value), {}}); }
    /// A block that is called in each scan and shown; its outputs become bars as far as they are ever TRUE. The first axis' curve has
    /// its colour while it is Active.
    template <class Block>
    void block(const std::string& label, Block& block) {
        const int colour = blocks_;
        beside(label, block);
        // The curve is the first axis'. MC_Stop has no Active: it controls the axis from its edge on.
        if (!acts_on_the_first(block)) return;
        if constexpr (requires { block.Active; }) controls_.push_back({colour, &block.Active, nullptr});
        else if constexpr (std::is_same_v<Block, fb::MC_Stop>) controls_.push_back({colour, &block.Busy, &block.Execute});
    }
    /// The same for one that never controls the axis.
    template <class Block>
    void beside(const std::string& label, Block& block) {
        const int colour = blocks_++;
        const auto add = [&](const char* pin, const bool& value) {
            bars_.push_back({label + "." + pin, colour, [&value] { return value; }, {}});
        };
        if constexpr (requires { block.Execute; }) add("Execute", block.Execute);
        if constexpr (requires { block.Enable; }) add("Enable", block.Enable);
        if constexpr (requires { block.JogForward; }) add("JogForward", block.JogForward), add("JogBackwards", block.JogBackwards);
        if constexpr (requires { block.Busy; }) add("Busy", block.Busy);
        if constexpr (requires { block.Active; }) add("Active", block.Active);
        if constexpr (requires { block.StartSync; }) add("StartSync", block.StartSync);
        if constexpr (requires { block.Done; }) add("Done", block.Done);
        if constexpr (requires { block.InVelocity; }) add("InVelocity", block.InVelocity);
        if constexpr (requires { block.InEndVelocity; }) add("InEndVelocity", block.InEndVelocity);
        if constexpr (requires { block.InGear; }) add("InGear", block.InGear);
        if constexpr (requires { block.InSync; }) add("InSync", block.InSync);
        if constexpr (requires { block.Enabled; }) add("Enabled", block.Enabled);
        if constexpr (requires { block.InOperation; }) add("InOperation", block.InOperation);
        if constexpr (requires { block.InTorque; }) add("InTorque", block.InTorque);
        if constexpr (requires { block.ProfileCompleted; }) add("ProfileCompleted", block.ProfileCompleted);
        if constexpr (requires { block.EndOfProfile; }) add("EndOfProfile", block.EndOfProfile);
        if constexpr (requires { block.CommandAborted; }) add("CommandAborted", block.CommandAborted);
        if constexpr (requires { block.Error; }) add("Error", block.Error);
        calls_.push_back([&block](const fb::MotionContext& ctx) { block(ctx); });
    }
    /// Before the blocks are called.
    std::function<void(const fb::MotionContext&)> before;

    void scan();
    void run(Duration time) {
        for (Duration t{}; t < time; t += period) scan();
    }
    /// Throws when it does not come true: a picture of nothing is worse than none.
    void run_until(const std::function<bool()>& condition, Duration most = 20s);

    struct Shown {
        std::uint16_t axis = 0;
        Quantity quantity{};
        Ink ink = Ink::owner;
        std::string label{};
        const double* value = nullptr;  ///< shown instead of the axis
    };
    void show(const std::string& quantity, const std::string& unit, double height, const std::vector<Shown>& curves);
    /// What was noted, with the panels asked for; position and velocity of the first axis when none was.
    [[nodiscard]] Figure figure(const std::string& name);

private:
    template <class Block>
    static bool acts_on_the_first(const Block& block) {
        if constexpr (requires { block.Slave; }) return block.Slave == ref();
        else return block.Axis == ref();
    }
    struct Bar {
        std::string label;
        int block = 0;
        std::function<bool()> value;
        std::vector<bool> on;
    };
    struct Control {
        int block = 0;
        const bool *active = nullptr, *held = nullptr;
    };
    void bind();
    void cycle();
    void note();

    std::deque<axes::test::FakeDrive> drives_;
    std::vector<axes::Axis> axes_;
    std::vector<axes::test::MotionOracle> oracles_;
    axes::MotionTables tables_;
    axes::DirectRequests requests_;
    std::vector<fb::MC_Power> powers_;
    std::vector<axes::AxisView> seen_;
    std::vector<std::function<void(const fb::MotionContext&)>> calls_;
    std::vector<Bar> bars_;
    std::vector<Control> controls_;
    int blocks_ = 0;
    Figure figure_;
    std::vector<std::vector<Shown>> shown_;
    Instant now_{};
    std::uint64_t cycle_ = 0;
};

}  // namespace taktwerk::figures
