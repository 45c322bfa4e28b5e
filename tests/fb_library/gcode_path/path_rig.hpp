#pragma once
// A portal of three axes that goes a program in G-code, through the blocks, over fake drives in virtual time. The rig below asserts the axes' limits and the continuity of
// every set-point in every cycle.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "fb_library/gcode_path/gcode_path.hpp"
#include "fb_library/gcode_path/line_merger.hpp"
#include "tests/fb_library/groups/group_plc.hpp"

namespace taktwerk::fb {

/// 100 mm/s, 1000 mm/s2, 10000 mm/s3 each.
struct PathRig {
    explicit PathRig(const std::string& text, gcode::InterpreterOptions options = {}, double stroke = 0)
        : plc(axes_of(stroke), {group()}, makers(text, options)) {
        MC_GroupEnable enable;
        plc.carry_out(enable);
        select.AxesGroup = move.AxesGroup = handshake.AxesGroup = plc.group;
        select.PathDescription.Path = {0};
        handshake.Enable = true;
        plc.program = [this](const MotionContext& ctx) {
            if (extra) extra(ctx);
            select(ctx);
            move.PathData = select.PathData;
            move(ctx);
            if (acknowledges) handshake.Acknowledge = handshake.Waits && !handshake.Acknowledge;
            handshake(ctx);
            if (handshake.RequestID != seen_) requests.push_back({handshake.Request, handshake.Number, handshake.Value, at()});
            seen_ = handshake.RequestID;
            if (handshake.Line != 0 && (lines.empty() || lines.back() != handshake.Line)) lines.push_back(handshake.Line);
        };
    }

    static std::vector<axes::AxisConfig> axes_of(double stroke) {
        std::vector<axes::AxisConfig> configs;
        for (const char* name : {"x", "y", "z"}) {
            configs.push_back(axes::test::group_axis(name));
            configs.back().homing.kind = axes::HomingKind::set_here;
            if (stroke > 0) configs.back().limits.position_min = -stroke, configs.back().limits.position_max = stroke;
        }
        return configs;
    }
    static axes::AxisGroupConfig group() { return {.name = "g", .members = {"x", "y", "z"}, .kinematics = axes::test::cartesian_arm()}; }
    static std::vector<std::unique_ptr<axes::PathMaker>> makers(const std::string& text, const gcode::InterpreterOptions& options) {
        std::vector<std::unique_ptr<axes::PathMaker>> out;
        out.push_back(std::make_unique<gcode::GcodePathMaker>(std::make_shared<const std::string>(text), options));
        return out;
    }

    bool prepare() {
        select.Execute = true;
        const bool good = plc.until([&] { return select.Done || select.Error; }, 2000) && select.Done;
        return good;
    }
    /// Selects, then goes.
    bool begin() {
        if (!prepare()) return false;
        move.Execute = true;
        plc.scan();
        began = plc.rig.path.size();
        return !move.Error;
    }
    bool run(int most) {
        return begin() && plc.until([&] { return move.Done || move.Error || move.CommandAborted; }, most) && move.Done;
    }
    gcode::Point at() const { return {plc.rig.axis(0).set_position, plc.rig.axis(1).set_position, plc.rig.axis(2).set_position}; }
    gcode::Point at_cycle(std::size_t n) const { return {plc.rig.path[n][0], plc.rig.path[n][1], plc.rig.path[n][2]}; }

    struct Request {
        MC_PATH_REQUEST kind;
        std::uint32_t number;
        double value;
        gcode::Point place;
    };
    GroupPlc plc;
    MC_PathSelect select;
    MC_MovePath move;
    Path_Handshake handshake;
    std::function<void(const MotionContext&)> extra;
    bool acknowledges = true;
    std::vector<Request> requests;
    std::vector<std::uint32_t> lines;
    std::size_t began = 0;

private:
    std::uint32_t seen_ = 0;
};

inline double distance(const gcode::Point& a, const gcode::Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }
inline double off_line(const gcode::Point& p, const gcode::Point& a, const gcode::Point& b) {
    double along = 0, square = 0;
    for (std::size_t i = 0; i < 3; ++i) along += (p[i] - a[i]) * (b[i] - a[i]), square += (b[i] - a[i]) * (b[i] - a[i]);
    const double t = std::min(std::max(along / square, 0.0), 1.0);
    return distance(p, {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
}

}  // namespace taktwerk::fb
