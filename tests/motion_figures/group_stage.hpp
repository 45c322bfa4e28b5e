#pragma once
// A group of real axes over fake drives in virtual time, for pictures: its path from above, and what its axes do over time, every scan noted.

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/fb_library/groups/group_plc.hpp"
#include "tests/motion_figures/figure.hpp"

namespace taktwerk::figures {

class GroupStage {
public:
    /// mm; 200 mm/s, 1000 mm/s2, 10000 mm/s3.
    static axes::AxisConfig linear(const std::string& name);
    /// X and Y under an arm whose tool is where they are.
    GroupStage();
    explicit GroupStage(const std::vector<axes::AxisConfig>& configs, axes::test::Arm arm);

    [[nodiscard]] const axes::GroupView& view() const { return plc_.rig.view(); }
    [[nodiscard]] axes::test::GroupRig& rig() { return plc_.rig; }

    /// Called in each scan, and shown as bars; the path has its colour while it is Active.
    template <class Block>
    void block(const std::string& label, Block& block) {
        const int colour = blocks_++;
        block.AxesGroup = fb::GroupPlc::group;
        const auto add = [&](const char* pin, const bool& value) { bars_.push_back({label + "." + pin, colour, &value, {}}); };
        if constexpr (requires { block.Execute; }) add("Execute", block.Execute);
        if constexpr (requires { block.Enable; }) add("Enable", block.Enable);
        if constexpr (requires { block.Busy; }) add("Busy", block.Busy);
        if constexpr (requires { block.Active; }) add("Active", block.Active), actives_.push_back({colour, &block.Active});
        if constexpr (requires { block.Done; }) add("Done", block.Done);
        if constexpr (requires { block.CommandAborted; }) add("CommandAborted", block.CommandAborted);
        if constexpr (requires { block.Error; }) add("Error", block.Error);
        calls_.push_back([&block](const fb::MotionContext& ctx) { block(ctx); });
    }

    /// Before the picture begins.
    template <class Block>
    void beforehand(Block& block) {
        if (plc_.carry_out(block, 20'000) != fb::ErrorId::none) throw std::runtime_error("a figure could not be prepared");
    }

    struct Shown {
        std::function<double(const axes::GroupView&)> value;
        std::string label{};
        Ink ink = Ink::plain;
    };
    void show(const std::string& quantity, const std::string& unit, double height, std::vector<Shown> curves);
    /// The tool's way from above, `height` pixels high.
    void show_way(double height) { figure_.way_height = height; }

    void scan();
    void run(Duration time);
    /// Throws when it does not come true.
    void run_until(const std::function<bool()>& condition, Duration most = std::chrono::seconds{20});
    [[nodiscard]] Figure figure(const std::string& name);

private:
    struct Bar {
        std::string label;
        int block = 0;
        const bool* value = nullptr;
        std::vector<bool> on;
    };
    struct Active {
        int block = 0;
        const bool* active = nullptr;
    };

    fb::GroupPlc plc_;
    std::vector<std::function<void(const fb::MotionContext&)>> calls_;
    std::vector<Bar> bars_;
    std::vector<Active> actives_;
    std::vector<std::vector<Shown>> shown_;
    int blocks_ = 0;
    Figure figure_;
};

}  // namespace taktwerk::figures
