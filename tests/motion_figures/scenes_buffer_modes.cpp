// Appendix A of the standard: the same moves under each buffer mode.
#include "fb_library/motion/moves.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

/// To 100 fast, to 150 slowly, to 250 fast: the joints show what the mode means.
Figure three_moves(const std::string& name, MC_BufferMode mode) {
    Stage stage;
    MC_MoveAbsolute first, second, third;
    first.Axis = second.Axis = third.Axis = Stage::ref();
    first.Position = 100, second.Position = 150, third.Position = 250;
    first.Velocity = third.Velocity = 100, second.Velocity = 50;
    for (auto* move : {&first, &second, &third}) move->Acceleration = move->Deceleration = 200, move->Jerk = 4000;
    second.BufferMode = third.BufferMode = mode;
    stage.block("first", first);
    stage.block("second", second);
    stage.block("third", third);
    stage.run(200ms);
    first.Execute = true;
    stage.run(mode == mcAborting ? 900ms : 200ms);
    second.Execute = true;
    stage.run(mode == mcAborting ? 500ms : 200ms);
    third.Execute = true;
    stage.run_until([&] { return third.Done; });
    stage.run(300ms);
    return stage.figure(name);
}

}  // namespace

std::vector<Figure> buffer_modes() {
    return {three_moves("aborting", mcAborting),          three_moves("buffered", mcBuffered),
            three_moves("blending-low", mcBlendingLow),   three_moves("blending-previous", mcBlendingPrevious),
            three_moves("blending-next", mcBlendingNext), three_moves("blending-high", mcBlendingHigh)};
}

}  // namespace taktwerk::figures
