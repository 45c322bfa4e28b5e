#include "fb_library/motion/time_profiles.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

Figure position_profile() {
    Stage stage;
    const std::vector<axes::TimePoint> points{{0ms, 0}, {800ms, 30}, {600ms, 60}, {700ms, 60}, {800ms, 20}, {900ms, 0}};
    MC_PositionProfile profile;
    profile.Axis = Stage::ref();
    profile.TimePosition = stage.time_table(points);
    stage.block("profile", profile);
    stage.run(200ms);
    profile.Execute = true;
    stage.run_until([&] { return profile.Done; });
    stage.run(300ms);
    return stage.figure("position-profile");
}

Figure velocity_profile() {
    Stage stage;
    const std::vector<axes::TimePoint> points{{0ms, 0}, {500ms, 60}, {500ms, 60}, {300ms, 20}, {300ms, 40}};
    MC_VelocityProfile profile;
    profile.Axis = Stage::ref();
    profile.TimeVelocity = stage.time_table(points);
    stage.block("profile", profile);
    stage.run(200ms);
    profile.Execute = true;
    stage.run_until([&] { return profile.ProfileCompleted; });
    stage.run(500ms);
    return stage.figure("velocity-profile");
}

Figure acceleration_profile() {
    Stage stage;
    const std::vector<axes::TimePoint> points{{400ms, 150}, {300ms, 0}, {400ms, -80}};
    MC_AccelerationProfile profile;
    profile.Axis = Stage::ref();
    profile.TimeAcceleration = stage.time_table(points);
    stage.block("profile", profile);
    stage.show("acceleration", "mm/s²", 70, {{0, Quantity::acceleration}});
    stage.show("velocity", "mm/s", 90, {{0, Quantity::velocity}});
    stage.run(200ms);
    profile.Execute = true;
    stage.run_until([&] { return profile.ProfileCompleted; });
    stage.run(500ms);
    return stage.figure("acceleration-profile");
}

}  // namespace

std::vector<Figure> time_profiles() { return {position_profile(), velocity_profile(), acceleration_profile()}; }

}  // namespace taktwerk::figures
