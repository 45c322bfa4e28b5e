#pragma once
// A setting that is written again and again: what the axis says to it. Plain data, a member of a block. Real-time safe.

#include "fb_library/motion/enable_core.hpp"

namespace taktwerk::fb {

/// In the base task the answer comes at once. In a slower task it comes with the next views; until then the last one stands.
class SettingFollower {
public:
    [[nodiscard]] Reading ask(const MotionContext& ctx, AxisRef axis, const axes::AxisSetting& setting) noexcept {
        if (asked_ != 0) {
            ErrorId error = ErrorId::none;
            switch (ctx.view(axis)->status(asked_, &error)) {
                case axes::CommandStatus::done: answer_ = Reading::valid(); break;
                case axes::CommandStatus::error: answer_ = Reading::unless(error); break;
                default: break;
            }
        }
        const axes::Submitted answer = ctx.requests->set(axis, setting, ctx.owner);
        asked_ = answer.id;
        if (asked_ == 0) answer_ = Reading::unless(answer.error);
        return answer_;
    }

private:
    Reading answer_{};
    axes::CommandId asked_ = 0;
};

}  // namespace taktwerk::fb
