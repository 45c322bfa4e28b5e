// A turntable: 360 degrees, then again from 0.
#include <array>

#include "fb_library/motion/moves.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

axes::AxisConfig turning(const std::string& name, double modulo) {
    auto config = Stage::linear(name);
    config.unit = "deg";
    config.gearing = {.counts_per_revolution = 360000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 360};
    config.limits = {.velocity = 400, .acceleration = 2000, .deceleration = 2000, .jerk = 40000};
    config.modulo = modulo;
    return config;
}

Figure directions() {
    Stage stage{{turning("table", 360)}};
    struct Way {
        const char* label;
        MC_Direction direction;
        double position;
    };
    constexpr std::array ways{Way{"positive", mcPositiveDirection, 90}, Way{"shortest", mcShortestWay, 330},
                              Way{"negative", mcNegativeDirection, 30}, Way{"current", mcCurrentDirection, 240}};
    std::array<MC_MoveAbsolute, 4> moves;
    for (std::size_t i = 0; i < ways.size(); ++i) {
        auto& move = moves[i];
        move.Axis = Stage::ref();
        move.Position = ways[i].position, move.Direction = ways[i].direction;
        move.Velocity = 300, move.Acceleration = move.Deceleration = 1500;
        stage.block(ways[i].label, move);
    }
    stage.show("velocity", "deg/s", 80, {{0, Quantity::velocity}});
    stage.show("position", "deg", 120, {{0, Quantity::position}});
    stage.run(200ms);
    for (auto& move : moves) {
        move.Execute = true;
        stage.run_until([&] { return move.Done; });
        stage.run(150ms);
        move.Execute = false;
    }
    return stage.figure("modulo-directions");
}

}  // namespace

std::vector<Figure> modulo() { return {directions()}; }

}  // namespace taktwerk::figures
