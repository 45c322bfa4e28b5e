#pragma once
// Blocks on a real group over fake drives, in virtual time: scans as a base task runs them.

#include <functional>
#include <vector>

#include "axes/axis/direct_requests.hpp"
#include "fb_library/all_blocks.hpp"
#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::fb {

struct GroupPlc {
    explicit GroupPlc(std::size_t count, axes::test::Arm kinematics = {}) : rig(count, kinematics) { bind(); }
    GroupPlc(const std::vector<axes::AxisConfig>& configs, const std::vector<axes::AxisGroupConfig>& groups,
             std::vector<std::unique_ptr<axes::PathMaker>> paths = {})
        : rig(configs, groups, std::move(paths)) {
        bind();
    }

    /// One cycle; blocks see the axes as they were at its beginning.
    void scan() {
        rig.step([this] {
            views.clear();
            for (const auto& axis : rig.axes) views.push_back(axis.view());
            context.now = rig.now;
            context.period = axes::test::GroupRig::cycle;
            ++context.cycle;
            context.axes = views;
            if (program) program(context);
        });
    }
    void run(int scans) {
        for (int i = 0; i < scans; ++i) scan();
    }
    bool until(const std::function<bool()>& condition, int most) {
        for (int i = 0; i < most && !condition(); ++i) scan();
        return condition();
    }
    /// Calls a block with a rising edge until it is finished; with what, its next call does not say any more.
    template <class Block>
    ErrorId carry_out(Block& block, int most = 20) {
        const auto before = program;
        block.AxesGroup = group;
        block.Execute = true;
        program = [&](const MotionContext& ctx) {
            if (before) before(ctx);
            block(ctx);
        };
        EXPECT_TRUE(until([&] { return block.Done || block.Error; }, most));
        const ErrorId error = block.ErrorID;
        block.Execute = false;
        scan();
        program = before;
        return error;
    }

    static constexpr GroupRef group{0};
    axes::test::GroupRig rig;
    MotionContext context;
    std::function<void(const MotionContext&)> program;

private:
    void bind() {
        requests = axes::DirectRequests{rig.axes};
        context.requests = &requests;
        context.groups = &rig.groups;
        context.owner = axes::Owner::program;
    }
    axes::DirectRequests requests;
    std::vector<axes::AxisView> views;
};

}  // namespace taktwerk::fb
