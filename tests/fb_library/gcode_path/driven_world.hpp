#pragma once
// A group whose path an axis drives, under a careless hand: the axis turns, stops, fails, is homed, pushed, coupled; the group is halted, interrupted, stopped, disabled, driven anew, at
// any moment. What is true is kept by hand beside it: the arms' forward kinematics, the program's lines and arcs, the master's way.

#include <algorithm>
#include <random>
#include <sstream>

#include "tests/axes/group/flange_by_hand.hpp"
#include "tests/fb_library/gcode_path/path_rig.hpp"

namespace taktwerk::fb {

using axes::test::far;
using axes::test::flange_by_hand;
using axes::test::JogArm;
using axes::test::Spot;

/// A program in G-code and what it draws, seen from where it begins.
struct DrawnPath {
    struct Piece {
        Spot from{}, to{}, centre{};
        bool arc = false, left = false;
        double radius = 0, begins = 0, sweeps = 0;
        [[nodiscard]] double off(const Spot& p) const {
            if (!arc) {
                double along = 0, square = 0;
                for (std::size_t i = 0; i < 3; ++i)
                    along += (p[i] - from[i]) * (to[i] - from[i]), square += (to[i] - from[i]) * (to[i] - from[i]);
                const double t = std::clamp(along / square, 0.0, 1.0);
                return far(p, {from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]), from[2] + t * (to[2] - from[2])});
            }
            double a = std::atan2(p[1] - centre[1], p[0] - centre[0]) - begins;
            if (!left) a = -a;
            a = std::fmod(std::fmod(a, 2 * std::numbers::pi) + 2 * std::numbers::pi, 2 * std::numbers::pi);
            const double on = std::hypot(std::hypot(p[0] - centre[0], p[1] - centre[1]) - radius, p[2] - centre[2]);
            return a <= sweeps ? on : std::min(far(p, from), far(p, to));
        }
        [[nodiscard]] double length() const { return arc ? radius * sweeps : far(from, to); }
        [[nodiscard]] Spot middle() const {
            if (!arc) return {(from[0] + to[0]) / 2, (from[1] + to[1]) / 2, (from[2] + to[2]) / 2};
            const double a = begins + (left ? 1 : -1) * sweeps / 2;
            return {centre[0] + radius * std::cos(a), centre[1] + radius * std::sin(a), centre[2]};
        }
    };
    std::string text;
    std::vector<Piece> pieces;
    double tolerance = 0;  ///< P
    bool closed = false;

    [[nodiscard]] double off(const Spot& p) const {
        double least = 1e9;
        for (const auto& piece : pieces) least = std::min(least, piece.off(p));
        return least;
    }
};

class PathPainter {
public:
    explicit PathPainter(std::mt19937& dice) : dice_(dice) {}
    DrawnPath closed_polygon(double size, double tolerance) {
        start(tolerance);
        path_.closed = true;
        const double a = rounded(uniform(0.4, 1) * size), b = rounded(uniform(0.4, 1) * size);
        line(a, 0, 0), line(0, b, 0), line(-2 * a, 0, 0), line(0, -b, 0), line(a, 0, 0);
        return finish();
    }
    DrawnPath circle(double radius) {
        start(0);
        path_.closed = true;
        arc(0, 0, rounded(radius), 0, uniform(0, 1) < 0.5);
        return finish();
    }
    DrawnPath wild(double size, double tolerance, int count) {
        start(tolerance);
        double heading = uniform(-3, 3);
        for (int i = 0; i < count; ++i) {
            heading += uniform(-2, 2);
            const double way = size * std::exp(uniform(-1.2, 0));
            const double x = rounded(way * std::cos(heading)), y = rounded(way * std::sin(heading));
            const bool back = std::hypot(at_[0] + x, at_[1] + y) > 1.5 * size;
            if (back) heading += std::numbers::pi / 2;
            if (back && i > 0) {
                line(rounded(-at_[0] / 2 + 1), rounded(-at_[1] / 2 + 0.5), 0);
                heading = std::atan2(-at_[1], -at_[0]);
            } else if (uniform(0, 1) < 0.3) {
                arc(x, y, rounded(x / 2 - y), rounded(y / 2 + x), true);
            } else {
                line(x, y, rounded(uniform(-0.2, 0.2) * size - 0.3 * at_[2]));
            }
        }
        return finish();
    }
    DrawnPath one_line(double x, double y) {
        start(0);
        line(rounded(x), rounded(y), 0);
        return finish();
    }

private:
    double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(dice_); }
    static double rounded(double x) { return std::round(x * 1000) / 1000; }
    static std::string word(char letter, double value) {
        char out[32];
        std::snprintf(out, sizeof out, " %c%.3f", letter, value);
        return out;
    }
    void start(double tolerance) {
        path_ = {};
        at_ = {};
        path_.tolerance = tolerance;
        path_.text = tolerance > 0 ? "G21 G91 G17 G64" + word('P', tolerance) + " F3000\n" : "G21 G91 G17 G61 F3000\n";
    }
    DrawnPath finish() {
        path_.text += "M2\n";
        return path_;
    }
    void line(double x, double y, double z) {
        DrawnPath::Piece piece;
        piece.from = at_;
        at_ = piece.to = {at_[0] + x, at_[1] + y, at_[2] + z};
        path_.pieces.push_back(piece);
        path_.text += "G1" + word('X', x) + word('Y', y) + word('Z', z) + "\n";
    }
    /// About a centre seen from where it begins.
    void arc(double x, double y, double i, double j, bool left) {
        DrawnPath::Piece piece;
        piece.arc = true;
        piece.left = left;
        piece.from = at_;
        piece.centre = {at_[0] + i, at_[1] + j, at_[2]};
        piece.radius = std::hypot(i, j);
        at_ = piece.to = {at_[0] + x, at_[1] + y, at_[2]};
        piece.begins = std::atan2(-j, -i);
        double sweep = std::atan2(piece.to[1] - piece.centre[1], piece.to[0] - piece.centre[0]) - piece.begins;
        if (!left) sweep = -sweep;
        sweep = std::fmod(std::fmod(sweep, 2 * std::numbers::pi) + 2 * std::numbers::pi, 2 * std::numbers::pi);
        piece.sweeps = x == 0 && y == 0 ? 2 * std::numbers::pi : sweep;
        path_.pieces.push_back(piece);
        path_.text += (left ? "G3" : "G2") + word('X', x) + word('Y', y) + word('I', i) + word('J', j) + "\n";
    }

    std::mt19937& dice_;
    DrawnPath path_;
    Spot at_{};
};

struct DrivenWorld {
    DrivenWorld(const JogArm& its_arm, std::uint32_t seed)
        : arm(its_arm),
          dice(seed),
          drawn(draw_path(seed)),
          count(arm.turning.size()),
          plc(with(arm, master_axis(seed)), {group_of(arm)}, PathRig::makers(drawn.text, {})) {
        auto& r = plc.rig;
        r.enable();
        auto there = axes::GroupCommand{.kind = axes::GroupCommandKind::direct_absolute, .target = arm.start};
        const auto ready = r.give(there);
        EXPECT_TRUE(r.until([&] { return r.status(ready.id) == axes::CommandStatus::done; }, 20000));
        r.trembles = encoder;
        select.AxesGroup = sync.AxesGroup = plc.group;
        select.PathDescription.Path = {0};
        sync.Master = master();
        gear.Master = {static_cast<std::uint16_t>(count + 1)};
        gear.Slave = master();
        plc.program = [this](const MotionContext& ctx) {
            select(ctx);
            sync.PathData = select.PathData;
            sync(ctx);
            gear(ctx);
            for (const auto& deed : deeds) deed();
            deeds.clear();
        };
        select.Execute = true;
        EXPECT_TRUE(plc.until([&] { return select.Done || select.Error; }, 2000) && select.Done) << drawn.text;
        at_master = master_at();
    }

    // --- the world ------------------------------------------------------------------------------------------------------------
    DrawnPath draw_path(std::uint32_t seed) {
        PathPainter painter(dice);
        const double size = arm.name == "cartesian" ? 40 : 12, tolerance = std::exp(std::uniform_real_distribution<double>(-3, 0.5)(dice));
        switch (seed % 5) {
            case 0: return painter.circle(size * 0.6);
            case 1: return painter.closed_polygon(size, tolerance);
            case 2: return painter.one_line(size, size / 3);
            default: return painter.wild(size, tolerance, 2 + static_cast<int>(seed % 7));
        }
    }
    axes::AxisConfig master_axis(std::uint32_t seed) {
        const double v = draw(30, 120), a = draw(50, 400), j = std::min(a * draw(4, 40), 3000.0);
        auto axis = axes::test::group_axis("wheel", {.velocity = v, .acceleration = a, .deceleration = a, .jerk = j});
        axis.homing.kind = axes::HomingKind::set_here;
        encoder = seed % 4 == 3;
        if (encoder) {
            axis.encoder = true;
            axis.limits = {.velocity = v};
            axis.gearing.counts_per_revolution *= 1000;
        }
        most = v;
        return axis;
    }
    static std::vector<axes::AxisConfig> with(const JogArm& arm, const axes::AxisConfig& wheel) {
        auto all = axes::test::axes_of(arm);
        all.push_back(wheel);
        all.push_back(axes::test::group_axis("lead", {.velocity = 80, .acceleration = 200, .deceleration = 200, .jerk = 2000}));
        return all;
    }
    static axes::AxisGroupConfig group_of(const JogArm& arm) {
        axes::AxisGroupConfig group{.name = "g", .members = {}, .kinematics = axes::test::arm_of(arm.description)};
        for (const auto& axis : axes::test::axes_of(arm)) group.members.push_back(axis.name);
        return group;
    }
    [[nodiscard]] AxisRef master() const { return {static_cast<std::uint16_t>(count)}; }
    [[nodiscard]] double master_at() const { return encoder ? plc.rig.axis(count).actual_position : plc.rig.axis(count).set_position; }
    [[nodiscard]] const axes::GroupView& view() const { return plc.rig.view(); }
    [[nodiscard]] Spot tool() const {
        return flange_by_hand(arm, view().set_position, {view().tool_set[0], view().tool_set[1], view().tool_set[2]});
    }
    double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(dice); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(dice); }
    bool once_in(int n) { return whole(1, n) == 1; }

    void note(const std::string& what) {
        if (log.size() > 40) log.erase(log.begin());
        log.push_back(std::to_string(plc.rig.path.size()) + ": " + what);
    }
    [[nodiscard]] std::string story() const {
        std::ostringstream all;
        all << drawn.text;
        for (const auto& line : log) all << line << "\n";
        all << "state " << static_cast<int>(view().state) << " error " << std::hex << view().error << std::dec << " active "
            << view().active << " kind " << static_cast<int>(view().active_kind) << " driver sync " << view().driver.in_sync
            << " interrupted " << view().interrupted << " cycle " << plc.rig.path.size() << " v " << view().path_velocity << " a "
            << view().path_acceleration << " s " << s << " master v " << plc.rig.axis(count).set_velocity << " ratio " << sync.TuCNumerator
            << "/" << sync.TuCDenominator << " mode " << int(sync.Mode);
        return all.str();
    }

    // --- the hand -------------------------------------------------------------------------------------------------------------
    void drive_anew() {
        sync.Execute = false;
        scan();
        sync.TuCNumerator = static_cast<std::int16_t>(whole(1, 4) * (once_in(3) ? -1 : 1));
        sync.TuCDenominator = static_cast<std::uint16_t>(whole(1, 3));
        sync.Mode = drawn.closed && !once_in(3) ? mcPeriodic : mcNonPeriodic;
        sync.Acceleration = once_in(3) ? draw(5, 500) : 0;
        sync.Deceleration = once_in(3) ? draw(5, 500) : 0;
        sync.Jerk = once_in(3) ? draw(50, 5000) : 0;
        sync.BufferMode = once_in(2) ? mcBuffered : mcAborting;
        sync.Execute = true;
        note("drive " + std::to_string(sync.TuCNumerator) + "/" + std::to_string(sync.TuCDenominator) + " mode " +
             std::to_string(sync.Mode) + " buffer " + std::to_string(sync.BufferMode));
        scan();
        if (!sync.Error) accepted_ratio = static_cast<double>(sync.TuCDenominator) / sync.TuCNumerator;
        note("  error " + std::to_string(static_cast<int>(sync.ErrorID)));
    }
    void move_master() {
        if (encoder) {
            coasts = once_in(4) ? 0 : draw(-calm * most, calm * most);
            note("wheel at " + std::to_string(coasts));
            return;
        }
        axes::AxisCommand c{.kind = axes::CommandKind::halt};
        switch (whole(0, 4)) {
            case 0: c = {.kind = axes::CommandKind::move_velocity, .velocity = draw(-calm * most, calm * most)}; break;
            case 1:
            case 2: c = {.kind = axes::CommandKind::move_relative, .position = draw(-60, 60), .velocity = draw(1, calm * most)}; break;
            case 3: c = {.kind = axes::CommandKind::move_relative, .position = draw(-3, 3), .velocity = draw(1, calm * most)}; break;
            default: break;
        }
        note("master kind " + std::to_string(static_cast<int>(c.kind)) + " p " + std::to_string(c.position) + " v " +
             std::to_string(c.velocity));
        deeds.push_back([this, c] { (void)plc.rig.axes[count].submit(c, axes::Owner::program); });
    }
    void group(axes::GroupCommandKind kind, axes::PathDynamics d = {}) {
        deeds.push_back([this, kind, d] {
            const auto answer = plc.rig.submit(axes::test::simply(kind, d));
            note("group " + std::to_string(static_cast<int>(kind)) + " dec " + std::to_string(d.deceleration) + " -> " +
                 std::to_string(static_cast<int>(answer.error)));
            if (kind == axes::GroupCommandKind::stop && answer.error == ErrorId::none) lock = answer.id;
        });
    }
    [[nodiscard]] axes::PathDynamics ramp() {
        return once_in(2) ? axes::PathDynamics{} : axes::PathDynamics{0, 0, draw(5, 2000), once_in(2) ? draw(50, 30000) : 0};
    }
    void deed() {
        using enum axes::GroupCommandKind;
        if (!sync.Busy && once_in(3)) return drive_anew();
        switch (whole(0, 24)) {
            case 0: return drive_anew();
            case 1: return group(halt, ramp());
            case 2: return group(interrupt, ramp());
            case 3:
            case 4: return group(resume);
            case 5: return once_in(2) ? group(stop, ramp()) : void();
            case 6: return once_in(4) ? group(disable) : void();
            case 7: {
                note("back home");
                deeds.push_back([this] {
                    auto back = axes::GroupCommand{.kind = axes::GroupCommandKind::direct_absolute, .target = arm.start};
                    for (std::size_t i = 0; i < count; ++i) back.target[i] += draw(-2, 2);
                    back.buffer_mode = once_in(2) ? mcAborting : mcBuffered;
                    (void)plc.rig.submit(back);
                });
                return;
            }
            case 8: deeds.push_back([this] { (void)plc.rig.set(axes::Override{draw(0, 1), draw(0.1, 1), draw(0.1, 1)}); }); return;
            case 9:
                note("execute falls");
                sync.Execute = false;
                return;
            case 10:
                if (encoder || !once_in(2)) return;
                note("new numbers");
                deeds.push_back([this] {
                    if (plc.rig.axes[count].set(axes::SetPosition{.position = draw(-500, 500)}, axes::Owner::program) == ErrorId::none)
                        renumbered = true;
                });
                return;
            case 11:
                if (encoder || !once_in(2)) return;
                note("home of the master");
                deeds.push_back([this] {
                    if (plc.rig.axes[count].submit(axes::test::home(draw(-300, 300)), axes::Owner::program).error == ErrorId::none)
                        homes = 30;
                });
                return;
            case 12:
                if (encoder || !troubles) return;
                note("geared");
                gear.Execute = !gear.Execute;
                gear.RatioNumerator = whole(-3, 3) == 0 ? 1 : whole(1, 3);
                geared = true;
                return;
            case 13:
                deeds.push_back([this] {
                    (void)plc.rig.axes[count + 1].submit(
                        {.kind = axes::CommandKind::move_velocity, .velocity = draw(-calm * 60, calm * 60)}, axes::Owner::program);
                });
                return;
            case 14:
                if (!troubles || !once_in(3)) return;
                note("fault of the master");
                plc.rig.drives[count]->fault_code = 0x5441;
                heal_at = 300;
                return;
            case 15:
                if (!troubles || encoder || !once_in(3)) return;
                note("power of the master " + std::to_string(!plc.rig.powered[count]));
                plc.rig.powered[count] = !plc.rig.powered[count];
                if (!plc.rig.powered[count])
                    deeds.push_back([this] { (void)plc.rig.axes[count].power(false, true, true, axes::Owner::program); });
                pushed = true;
                return;
            case 16: {
                if (!troubles || !once_in(4)) return;
                const auto i = static_cast<std::size_t>(whole(0, static_cast<int>(count) - 1));
                note("fault of member " + std::to_string(i));
                plc.rig.drives[i]->fault_code = 0x5441;
                heal_at = 300;
                return;
            }
            case 17:
                note("let go");
                deeds.push_back([this] { plc.rig.groups[0].let_go(); });
                return;
            default: return move_master();
        }
    }
    void heal() {
        if (heal_at > 0) return;
        if (view().state == axes::GroupState::GroupErrorStop && !plc.rig.groups[0].leads())
            deeds.push_back([this] { (void)plc.rig.groups.reset(plc.group, axes::Owner::program); });
        if (plc.rig.axis(count).state == axes::AxisState::ErrorStop)
            deeds.push_back([this] { (void)plc.rig.axes[count].reset(axes::Owner::program); });
        if (view().state == axes::GroupState::GroupDisabled) deeds.push_back([this] { (void)plc.rig.set(axes::EnableGroup{}); });
        if (lock != 0 && once_in(200))
            deeds.push_back([this] { plc.rig.groups.release_stop(plc.group, lock, axes::Owner::program), lock = 0; });
    }
    void live() {
        if (once_in(patience)) deed();
        if (heal_at > 0 && --heal_at == 0)
            for (auto& d : plc.rig.drives) d->fault_code = 0;
        if (once_in(50)) heal();
        scan();
    }

    // --- what must hold -------------------------------------------------------------------------------------------------------
    void scan() {
        if (encoder) {
            speed_of_wheel += std::clamp(coasts - speed_of_wheel, -0.2, 0.2);
            auto& wheel = *plc.rig.drives[count];
            wheel.coasting = speed_of_wheel * 1000 + (jitter ? draw(-0.5, 0.5) : 0);  // 1e6 counts a u, 1 ms
        }
        // Of what is measured the jerk is what it is.
        plc.rig.trembles = encoder || pushed;
        plc.scan();
        const double at = master_at();
        const bool other_numbers = renumbered || homes > 0;
        if (other_numbers) at_master = at;
        renumbered = false;
        homes = std::max(0, homes - 1);
        const double step_of_master = at - at_master;
        at_master = at;
        if (sync.Error && !was_refused)
            note("  error " + std::to_string(static_cast<int>(sync.ErrorID)) + " line " + std::to_string(view().path.place.line));
        was_refused = sync.Error;
        outputs();
        geometry(step_of_master, other_numbers);
    }
    void outputs() {
        const int ends = sync.Busy + sync.CommandAborted + sync.Error;
        if (sync.Execute) EXPECT_EQ(ends, 1) << sync.Busy << sync.CommandAborted << sync.Error << "\n" << story();
        else EXPECT_LE(ends, 1) << story();
        EXPECT_LE(sync.Active, sync.Busy) << story();
        EXPECT_LE(sync.InSync, sync.Active) << story();
        EXPECT_EQ(sync.Error, sync.ErrorID != ErrorId::none) << story();
    }
    void geometry(double step_of_master, bool other_numbers) {
        const bool led = plc.rig.groups[0].leads(), drives = led && view().driver.axis.valid();
        const auto p = tool();
        if (!drives) {
            const bool left = was_driven && !led && view().state == axes::GroupState::GroupErrorStop && std::abs(was_speed) > 1e-2;
            EXPECT_TRUE(!left || troubles) << "it has left the path\n" << story();
            was_driven = was_sync = false;
            last = p;
            return;
        }
        was_error = view().state == axes::GroupState::GroupErrorStop;
        const auto why = static_cast<ErrorId>(view().error);
        EXPECT_TRUE(!was_error || troubles || why == ErrorId::path_limit || why == ErrorId::master_lost) << story();
        if (!was_driven && view().active != driven) {
            driven = view().active;
            origin = last;
            ratio = accepted_ratio;
        }
        const Spot from_start{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
        const double off = drawn.off(from_start);
        EXPECT_LE(off, drawn.tolerance + 1e-8) << p[0] << " " << p[1] << " " << p[2] << "\n" << story();
        if (drawn.tolerance == 0) {
            EXPECT_LE(off, 1e-9 * 1000) << story();
        }
        for (const auto& piece : drawn.pieces) {
            if (far(from_start, piece.middle()) > 0.04 * piece.length()) continue;
            EXPECT_LE(piece.off(from_start), 1e-8) << story();
            ++middles;
        }
        s = view().path_gone;
        if (was_driven) {
            const double ds = s - was_s, dp = far(p, last);
            EXPECT_LE(dp, std::abs(ds) * (1 + 1e-6) + 1e-8) << story();
            EXPECT_GE(dp, std::abs(ds) * 0.97 - 2e-7) << ds << " " << dp << "\n" << story();
            if (view().driver.in_sync && was_sync && !encoder && !pushed && !other_numbers) {
                // A cycle ahead with the acceleration of now.
                const auto& l = plc.rig.axes[count].config().limits;
                const double jerk = geared ? 2 * l.acceleration / 1e-3 : l.jerk;
                EXPECT_NEAR(ds, ratio * step_of_master, std::abs(ratio) * jerk * 1e-9 + 1e-9) << story();
                ++synced;
            }
        }
        was_sync = view().driver.in_sync;
        was_s = s;
        was_speed = view().path_velocity;
        was_driven = true;
        last = p;
        ++compared;
    }

    void calm_down() {
        coasts = 0;
        for (auto& d : plc.rig.drives) d->fault_code = 0;
        heal_at = 0;
        gear.Execute = false;
        plc.rig.powered[count] = true;
        sync.Execute = false;
        for (int i = 0; i < 1500; ++i) {
            heal();
            if (i == 0)
                deeds.push_back([this] { (void)plc.rig.axes[count].submit({.kind = axes::CommandKind::halt}, axes::Owner::program); });
            if (lock != 0) deeds.push_back([this] { plc.rig.groups.release_stop(plc.group, lock, axes::Owner::program), lock = 0; });
            if (view().interrupted) group(axes::GroupCommandKind::resume);
            scan();
        }
        group(axes::GroupCommandKind::halt);
        for (int i = 0; i < 4000 && view().state != axes::GroupState::GroupStandby; ++i) {
            heal();
            scan();
        }
        EXPECT_EQ(view().state, axes::GroupState::GroupStandby) << story();
        EXPECT_FALSE(sync.Busy) << story();
        EXPECT_EQ(view().active, 0u) << story();
    }

    JogArm arm;
    std::mt19937 dice;
    DrawnPath drawn;
    std::size_t count;
    bool encoder = false;
    double most = 100;
    GroupPlc plc;
    MC_PathSelect select;
    MC_SyncGroupToAxis sync;
    MC_GearIn gear;
    std::vector<std::function<void()>> deeds;
    std::vector<std::string> log;
    bool renumbered = false, geared = false, pushed = false, troubles = false, jitter = true, was_error = false;
    bool was_driven = false, was_sync = false;
    int homes = 0, heal_at = 0, patience = 80;
    double calm = 0.5;
    double coasts = 0, speed_of_wheel = 0;
    double at_master = 0, s = 0, was_s = 0, was_speed = 0, ratio = 1, accepted_ratio = 1;
    axes::CommandId lock = 0, driven = 0;
    Spot origin{}, last{};
    std::size_t compared = 0, synced = 0, middles = 0;
    bool was_refused = false;
};

}  // namespace taktwerk::fb
