// Arms as people describe them in machine files: lengths, angles, senses, zeros and gears drawn at random, each in a unit of its own, read by the loader and
// compared with formulas that are written here anew, from the words of docs/motion/kinematics.md. Lengths in mm and angles in rad where nothing else is said.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "axes/kinematics/kinematics.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::config {
namespace {

constexpr double pi = std::numbers::pi;
using Six = std::array<double, 6>;
using Vec = std::array<double, 3>;

// --- frames, by hand -----------------------------------------------------------------------------------------------------------------

struct Place {
    std::array<Vec, 3> row{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Vec at{};
};
Vec turned(const Place& f, const Vec& v) {
    Vec r{};
    for (std::size_t i = 0; i < 3; ++i) r[i] = f.row[i][0] * v[0] + f.row[i][1] * v[1] + f.row[i][2] * v[2];
    return r;
}
Place operator*(const Place& a, const Place& b) {
    Place r;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) r.row[i][k] = a.row[i][0] * b.row[0][k] + a.row[i][1] * b.row[1][k] + a.row[i][2] * b.row[2][k];
    const auto way = turned(a, b.at);
    for (std::size_t i = 0; i < 3; ++i) r.at[i] = a.at[i] + way[i];
    return r;
}
Place about(int axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    Place r;
    if (axis == 0) r.row = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    if (axis == 1) r.row = {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
    if (axis == 2) r.row = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
    return r;
}
Place by(double x, double y, double z) {
    Place r;
    r.at = {x, y, z};
    return r;
}
/// x, y, z, then turns: first about Z, then the new Y, the new X.
Place of_six(const Six& s) { return by(s[0], s[1], s[2]) * about(2, s[5]) * about(1, s[4]) * about(0, s[3]); }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec cross(const Vec& a, const Vec& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
double length(const Vec& a) { return std::sqrt(dot(a, a)); }
Vec column(const Place& f, std::size_t k) { return {f.row[0][k], f.row[1][k], f.row[2][k]}; }

Place of_pose(const axes::Pose& pose, double scale) {
    const auto& q = pose.orientation;
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    Place r;
    r.row = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
              {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
              {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
    for (std::size_t i = 0; i < 3; ++i) r.at[i] = pose.position[i] * scale;
    return r;
}
double apart(const Place& a, const Place& b) { return length(minus(a.at, b.at)); }
double tilt(const Place& a, const Place& b) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(a.row[i][k] - b.row[i][k]));
    return most;
}

// --- the arms of docs/motion/kinematics.md -------------------------------------------------------------------------------------------

enum class Kind : std::uint8_t {
    cartesian,
    core_xy,
    beam,
    scara,
    palletizer,
    rotary,
    linear,
    wrist,
    table_wrist,
    table_parallel,
    table_modified
};
constexpr int kinds = 11;

struct Flags {
    std::optional<double> shoulder, elbow, wrist;  ///< the number whose sign a flag is
};

struct Arm {
    Kind kind{};
    std::vector<bool> turning;   ///< of the joints
    std::array<double, 10> l{};  ///< its lengths, in the order of its keys
    int turn_about = -1;
    bool turns = false;
    double first_arm = 0;
    std::array<std::array<double, 4>, 6> rows{};  ///< a, alpha, d, theta
    bool modified = false;
    std::array<Six, 6> deviation{};

    [[nodiscard]] std::vector<Place> chain(const Six& q) const {
        std::vector<Place> at{Place{}};
        const auto go = [&](const Place& link) { at.push_back(at.back() * link); };
        if (kind == Kind::wrist) {
            const double a1 = l[0], a2 = l[1], b = l[2], c1 = l[3], c2 = l[4], c3 = l[5], c4 = l[6];
            go(about(2, q[0]) * by(a1, 0, c1));
            go(about(1, q[1]) * by(0, 0, c2));
            go(about(1, q[2]) * by(a2, b, c3));
            go(about(2, q[3]));
            go(about(1, q[4]));
            go(about(2, q[5]) * by(0, 0, c4));
            return at;
        }
        if (modified) {
            for (std::size_t i = 0; i < 6; ++i) {
                const auto& [a, alpha, d, theta] = rows[i];
                go(about(0, alpha) * by(a, 0, 0) * about(2, theta + q[i]) * by(0, 0, d));
            }
            return at;
        }
        for (std::size_t i = 0; i < 6; ++i) {
            const auto& [a, alpha, d, theta] = rows[i];
            go(about(2, theta + q[i]) * by(0, 0, d) * by(a, 0, 0) * about(0, alpha));
        }
        return at;
    }

    /// Behind joint i, in the next joint's frame: only of classic tables here, whose frames those are once the next theta is turned.
    [[nodiscard]] Place six_flange(const Six& q) const {
        if (kind != Kind::table_wrist && kind != Kind::table_parallel) return chain(q).back();
        Place at;
        for (std::size_t i = 0; i < 6; ++i) {
            const auto& [a, alpha, d, theta] = rows[i];
            const double next = i < 5 ? rows[i + 1][3] : 0;
            at = at * about(2, (i == 0 ? theta : 0) + q[i]) * by(a, 0, d) * about(0, alpha) * about(2, next);
            const auto& off = deviation[i];
            at = at * by(off[0], off[1], off[2]) * about(0, off[3]) * about(1, off[4]) * about(2, off[5]);
        }
        return at;
    }

    /// Rods of one length from three centres: the lower point, by Newton.
    [[nodiscard]] static Vec hung(const std::array<Vec, 3>& centre, double rod) {
        Vec p{0, 0, std::min({centre[0][2], centre[1][2], centre[2][2]}) - rod};
        for (int n = 0; n < 60; ++n) {
            std::array<Vec, 3> u{};
            Vec f{};
            for (std::size_t i = 0; i < 3; ++i) {
                u[i] = minus(p, centre[i]);
                f[i] = (dot(u[i], u[i]) - rod * rod) / 2;
            }
            const double det = dot(u[0], cross(u[1], u[2]));
            const Vec a = cross(u[1], u[2]), b = cross(u[2], u[0]), c = cross(u[0], u[1]);
            for (std::size_t i = 0; i < 3; ++i) p[i] -= (f[0] * a[i] + f[1] * b[i] + f[2] * c[i]) / det;
        }
        return p;
    }

    [[nodiscard]] Place flange(const Six& q) const {
        switch (kind) {
            case Kind::cartesian:
            case Kind::core_xy: {
                Place f = by(q[0], q[1], turning.size() > 2 && !turning[2] ? q[2] : 0);
                if (turn_about >= 0) f = f * about(turn_about, q[turning.size() - 1]);
                return f;
            }
            case Kind::beam: {  // the beam from (q0, 0) to (q1, span); the carriage q2 along it
                const double skew = std::atan2(q[1] - q[0], l[0]);
                Place f = by(q[0], 0, q[3]) * about(2, -skew) * by(0, q[2], 0);
                return turns ? f * about(2, q[4]) : f;
            }
            case Kind::scara:
                return about(2, q[0]) * by(l[0], 0, 0) * about(2, q[1]) * by(l[1], 0, 0) * about(2, q[3]) * by(0, 0, l[2] + q[2]);
            case Kind::palletizer: {
                const double out = l[0] + l[2] * std::sin(q[1]) + l[3] * std::cos(q[2]) + l[4];
                const double up = l[1] + l[2] * std::cos(q[1]) - l[3] * std::sin(q[2]) - l[5];
                return about(2, q[0]) * by(out, 0, up) * about(2, q[3]);
            }
            case Kind::rotary:
            case Kind::linear: {
                std::array<Vec, 3> centre{};
                for (std::size_t i = 0; i < 3; ++i) {
                    const auto arm = about(2, first_arm + 2 * pi / 3 * static_cast<double>(i));
                    // The rod's joint at the elbow, less that at the platform: all rods from there to one point.
                    centre[i] = kind == Kind::rotary ? (arm * by(l[0] + l[2] * std::cos(q[i]) - l[1], 0, -l[2] * std::sin(q[i]))).at
                                                     : (arm * by(l[0] - l[1], 0, q[i])).at;
                }
                Place f;
                f.at = hung(centre, kind == Kind::rotary ? l[3] : l[2]);
                return turns ? f * about(2, q[3]) : f;
            }
            default: return six_flange(q);
        }
    }

    [[nodiscard]] Flags flags(const Six& q) const {
        Flags f;
        if (kind == Kind::scara) f.elbow = std::sin(q[1]);
        if (kind == Kind::palletizer) {
            f.shoulder = l[0] + l[2] * std::sin(q[1]) + l[3] * std::cos(q[2]) + l[4];
            f.elbow = std::cos(q[2] - q[1]);
        }
        if (kind == Kind::wrist) {
            const auto at = chain(q);
            const Vec front = column(about(2, q[0]), 0), left = column(about(2, q[0]), 1), centre = at[3].at;
            f.shoulder = dot(centre, front);
            auto fore = minus(centre, at[2].at);
            const double aside = dot(fore, left);
            for (std::size_t i = 0; i < 3; ++i) fore[i] -= aside * left[i];
            f.elbow = dot(cross(minus(at[2].at, at[1].at), fore), left);  // about y: forward
            f.wrist = std::sin(q[4]);
        }
        if (kind == Kind::table_parallel) {
            const auto at = chain(q);
            const Vec up{0, 0, 1}, across = column(at[1], 2);
            f.shoulder = dot(at[5].at, cross(up, across));
            f.elbow = std::sin(q[2]);
            f.wrist = std::sin(q[4]);
        }
        return f;
    }
};

// --- a file about it -----------------------------------------------------------------------------------------------------------------

class File {
public:
    explicit File(std::uint64_t seed) : random_(seed) {}

    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    bool once_in(int n) { return whole(1, n) == 1; }

    struct Unit {
        const char* name;
        double scale;  ///< mm, rad
    };
    static constexpr std::array<Unit, 4> lengths{{{"um", 1e-3}, {"mm", 1}, {"cm", 10}, {"m", 1000}}};
    static constexpr std::array<Unit, 3> angles{{{"deg", pi / 180}, {"rad", 1}, {"rev", 2 * pi}}};
    Unit any_length() { return lengths[static_cast<std::size_t>(whole(0, 3))]; }
    Unit any_angle() { return angles[static_cast<std::size_t>(whole(0, 2))]; }

    static std::string number(double v) {
        std::ostringstream s;
        s.precision(17);
        s << v;
        return s.str();
    }
    std::string mm(double v) {
        const auto unit = any_length();
        return number(v / unit.scale) + " " + unit.name;
    }
    std::string rad(double v) {
        const auto unit = any_angle();
        return number(v / unit.scale) + " " + unit.name;
    }
    static std::string in(const Unit& unit, double v) { return number(v / unit.scale) + " " + unit.name; }
    std::string six(const Six& s) {
        constexpr const char* keys[] = {"x", "y", "z", "rx", "ry", "rz"};
        std::string all;
        for (std::size_t i = 0; i < 6; ++i)
            if (s[i] != 0) all += (all.empty() ? "" : ", ") + std::string(keys[i]) + ": " + (i < 3 ? mm(s[i]) : rad(s[i]));
        return "{ " + all + " }";
    }
    Six drawn_six(double far, double turn) {
        Six s{};
        for (std::size_t i = 0; i < 6; ++i)
            if (once_in(2)) s[i] = i < 3 ? uniform(-far, far) : uniform(-turn, turn);
        return s;
    }

    Arm arm;
    Six base{}, tool{};
    std::vector<Unit> units;                ///< of the axes
    std::array<double, 6> sense{}, zero{};  ///< arm's = sense * joint + zero
    std::array<Six, 6> moved_by{};          ///< own units
    Unit group_unit{"mm", 1};
    bool deviated = false;

    std::string write(Kind kind) {
        arm.kind = kind;
        std::string shape = shape_of(kind);
        if (once_in(2)) base = drawn_six(2000, 3);
        if (once_in(2)) tool = drawn_six(200, 3);
        group_unit = any_length();
        const std::size_t n = arm.turning.size();
        std::string axes_text, members, joints;
        for (std::size_t i = 0; i < n; ++i) {
            units.push_back(arm.turning[i] ? any_angle() : any_length());
            const std::string u = units[i].name, name = "j" + std::to_string(i + 1);
            axes_text += "  " + name + ": { unit: " + u + ", gearing: { counts_per_revolution: 36000, feed: 360 " + u +
                         " }, limits: { velocity: 100 " + u + "/s, acceleration: 1000 " + u + "/s2, jerk: none } }\n";
            members += (i == 0 ? "" : ", ") + name;
        }
        sense.fill(1);
        for (std::size_t i = 0; i < n; ++i) {
            std::string own;
            const auto add = [&](const std::string& text) { own += (own.empty() ? "" : ", ") + text; };
            if (once_in(3)) {
                sense[i] = -1;
                add("reversed: true");
            }
            if (once_in(2)) {
                zero[i] = arm.turning[i] ? uniform(-pi, pi) : uniform(-100, 100);
                add("zero: " + (arm.turning[i] ? rad(zero[i]) : mm(zero[i])));
            }
            std::string gears;
            for (std::size_t k = 0; k < n && kind != Kind::core_xy; ++k)
                if (k != i && once_in(8)) {
                    // As big as half a turn for a turn, whatever the units are.
                    const double si = uniform(-0.4, 0.4) * (arm.turning[i] ? 1 : 20) / (arm.turning[k] ? 1 : 20);
                    moved_by[i][k] = si * units[k].scale / units[i].scale;
                    gears += (gears.empty() ? "" : ", ") + std::string("j") + std::to_string(k + 1) + ": " + number(moved_by[i][k]);
                }
            if (!gears.empty()) add("moved_by: { " + gears + " }");
            if (!own.empty()) joints += "        j" + std::to_string(i + 1) + ": { " + own + " }\n";
        }
        std::string deviations;
        if ((kind == Kind::table_wrist || kind == Kind::table_parallel) && once_in(2))
            for (std::size_t i = 0; i < 6; ++i) {
                arm.deviation[i] = drawn_six(0.4, 0.002);
                if (arm.deviation[i] == Six{}) continue;
                deviated = true;
                deviations += "        j" + std::to_string(i + 1) + ": " + six(arm.deviation[i]) + "\n";
            }
        std::string text = "version: 1\nname: drawn\ncycle: 1 ms\nbus: { interface: simulated, slaves: [] }\naxes:\n" + axes_text +
                           "groups:\n  arm:\n    unit: " + std::string(group_unit.name) + "\n    members: [" + members +
                           "]\n    kinematics:\n      " + shape + "\n";
        if (base != Six{}) text += "      base: " + six(base) + "\n";
        if (!deviations.empty()) text += "      deviations:\n" + deviations;
        if (!joints.empty()) text += "      joints:\n" + joints;
        if (tool != Six{}) {
            auto own = six(tool);
            text += "    tools: { pen: { number: 4, " + own.substr(2) + " }\n    tool: pen\n";
        }
        return text;
    }

    /// From axes in their own units to the arm's own joints.
    [[nodiscard]] Six joints_of(const axes::Joints& axes) const {
        const std::size_t n = arm.turning.size();
        std::array<std::array<double, 7>, 6> m{};
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < n; ++k) m[i][k] = moved_by[i][k] + (i == k ? 1 : 0);
            m[i][6] = axes[i];
        }
        if (arm.kind == Kind::core_xy) {  // the motors of one belt: x + y, x - y
            const double a = axes[0] * units[0].scale, b = axes[1] * units[1].scale;
            m[0][6] = (a + b) / 2 / units[0].scale;
            m[1][6] = (a - b) / 2 / units[1].scale;
        }
        for (std::size_t c = 0; c < n; ++c) {
            std::size_t best = c;
            for (std::size_t r = c; r < n; ++r)
                if (std::abs(m[r][c]) > std::abs(m[best][c])) best = r;
            std::swap(m[c], m[best]);
            for (std::size_t r = 0; r < n; ++r) {
                if (r == c) continue;
                const double f = m[r][c] / m[c][c];
                for (std::size_t k = c; k < 7; ++k) m[r][k] -= f * m[c][k];
            }
        }
        Six q{};
        for (std::size_t i = 0; i < n; ++i) q[i] = sense[i] * m[i][6] / m[i][i] * units[i].scale + zero[i];
        return q;
    }
    /// The other way round.
    [[nodiscard]] axes::Joints axes_of(const Six& q) const {
        const std::size_t n = arm.turning.size();
        Six joint{};
        for (std::size_t i = 0; i < n; ++i) joint[i] = sense[i] * (q[i] - zero[i]) / units[i].scale;
        axes::Joints axes{};
        for (std::size_t i = 0; i < n; ++i) {
            axes[i] = joint[i];
            for (std::size_t k = 0; k < n; ++k) axes[i] += moved_by[i][k] * joint[k];
        }
        if (arm.kind == Kind::core_xy) {
            const double x = joint[0] * units[0].scale, y = joint[1] * units[1].scale;
            axes[0] = (x + y) / units[0].scale;
            axes[1] = (x - y) / units[1].scale;
        }
        return axes;
    }
    [[nodiscard]] Place tool_point(const axes::Joints& axes) const { return of_six(base) * arm.flange(joints_of(axes)) * of_six(tool); }
    Six drawn_stand() {
        Six q{};
        for (std::size_t i = 0; i < arm.turning.size(); ++i) q[i] = arm.turning[i] ? uniform(-pi, pi) : uniform(-300, 300);
        if (arm.kind == Kind::rotary)
            for (std::size_t i = 0; i < 3; ++i) q[i] = uniform(-0.3, 0.9);
        if (arm.kind == Kind::linear)
            for (std::size_t i = 0; i < 3; ++i) q[i] = uniform(-30, 30);
        if (arm.kind == Kind::beam) q[1] = q[0];
        return q;
    }

private:
    std::string keyed(const std::string& key, const std::vector<std::pair<const char*, double>>& values, const std::string& rest = {}) {
        std::string all;
        for (std::size_t i = 0; i < values.size(); ++i) {
            arm.l[i] = values[i].second;
            all += (all.empty() ? "" : ", ") + std::string(values[i].first) + ": " + mm(values[i].second);
        }
        return key + ": { " + all + rest + " }";
    }
    std::string shape_of(Kind kind) {
        switch (kind) {
            case Kind::cartesian:
                arm.turning = {false, false, false};
                if (once_in(2)) {
                    arm.turn_about = whole(0, 2);
                    arm.turning.push_back(true);
                    return std::string("cartesian: { axes: XYZ, turn: ") + "ABC"[arm.turn_about] + " }";
                }
                return "cartesian: { axes: XYZ }";
            case Kind::core_xy: arm.turning = {false, false, false}; return "core_xy: { lift: true }";
            case Kind::beam:
                arm.turning = {false, false, false, false};
                arm.turns = once_in(2);
                if (arm.turns) arm.turning.push_back(true);
                return keyed("beam_gantry", {{"span", uniform(400, 3000)}}, arm.turns ? ", turns: true" : "");
            case Kind::scara:
                arm.turning = {true, true, false, true};
                return keyed("scara", {{"first", uniform(100, 500)}, {"second", uniform(100, 500)}, {"height", uniform(-300, 300)}});
            case Kind::palletizer:
                arm.turning = {true, true, true, true};
                return keyed("palletizer", {{"shoulder", uniform(-50, 300)},
                                            {"height", uniform(100, 900)},
                                            {"upper", uniform(300, 1000)},
                                            {"fore", uniform(300, 1000)},
                                            {"wrist", uniform(0, 250)},
                                            {"drop", uniform(-50, 250)}});
            case Kind::rotary:
            case Kind::linear: {
                arm.turning = {kind == Kind::rotary, kind == Kind::rotary, kind == Kind::rotary};
                arm.turns = once_in(2);
                if (arm.turns) arm.turning.push_back(true);
                arm.first_arm = uniform(-pi, pi);
                const auto rest = ", first_arm_at: " + rad(arm.first_arm) + (arm.turns ? ", turns: true" : "");
                if (kind == Kind::rotary)
                    return keyed("rotary_delta",
                                 {{"base_radius", uniform(120, 220)},
                                  {"platform_radius", uniform(30, 80)},
                                  {"upper", uniform(180, 300)},
                                  {"rod", uniform(650, 900)}},
                                 rest);
                return keyed("linear_delta",
                             {{"base_radius", uniform(150, 200)}, {"platform_radius", uniform(20, 50)}, {"rod", uniform(280, 400)}}, rest);
            }
            case Kind::wrist:
                arm.turning.assign(6, true);
                return keyed("wrist", {{"a1", uniform(-50, 200)},
                                       {"a2", uniform(-150, 50)},
                                       {"b", once_in(2) ? 0 : uniform(-60, 60)},
                                       {"c1", uniform(200, 700)},
                                       {"c2", uniform(200, 700)},
                                       {"c3", uniform(200, 700)},
                                       {"c4", uniform(0, 150)}});
            default: break;
        }
        arm.turning.assign(6, true);
        constexpr double right = pi / 2;
        if (kind == Kind::table_parallel)
            arm.rows = {{{0, right, uniform(80, 200), 0},
                         {-uniform(200, 600), 0, 0, 0},
                         {-uniform(200, 600), 0, 0, 0},
                         {0, right, uniform(60, 200), 0},
                         {0, -right, uniform(60, 150), 0},
                         {0, 0, uniform(60, 120), 0}}};
        else
            arm.rows = {{{uniform(-50, 200), -right, uniform(200, 600), 0},
                         {uniform(200, 600), 0, once_in(2) ? 0 : uniform(-60, 60), -right},
                         {uniform(-100, 100), -right, 0, 0},
                         {0, right, uniform(200, 600), 0},
                         {0, -right, 0, 0},
                         {0, 0, uniform(0, 120), 0}}};
        if (kind != Kind::table_parallel)
            for (auto& row : arm.rows)
                if (once_in(3)) row[3] += uniform(-pi, pi);
        if (kind == Kind::table_modified) {  // Craig: a and alpha of the link in front
            arm.modified = true;
            auto rows = arm.rows;
            for (std::size_t i = 0; i < 6; ++i) {
                rows[i][0] = i == 0 ? 0 : arm.rows[i - 1][0];
                rows[i][1] = i == 0 ? 0 : arm.rows[i - 1][1];
            }
            arm.rows = rows;
        }
        std::string text = std::string("dh:\n        convention: ") + (arm.modified ? "modified" : "classic") + "\n        rows:\n";
        for (const auto& [a, alpha, d, theta] : arm.rows)
            text += "          - { a: " + mm(a) + ", alpha: " + rad(alpha) + ", d: " + mm(d) + ", theta: " + rad(theta) + " }\n";
        text.pop_back();
        return text;
    }

    std::mt19937_64 random_;
};

constexpr double reach = 1500;  // mm: of the largest of them, in round numbers

std::shared_ptr<const axes::Kinematics> loaded(const std::string& text, axes::Pose& tool) {
    auto result = load_machine_text("drawn.yaml", text);
    if (const auto* errors = std::get_if<1>(&result)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        ADD_FAILURE() << text;
        return nullptr;
    }
    auto& group = std::get<0>(result).machine.axis_groups[0];
    group.equipment.arm = {};
    tool = group.equipment.tool_pose();
    return group.kinematics;
}

// The tool stands where the words of the file say; every way back to it comes back; flags are the signs of the numbers that the page names, also a hair
// beside where these vanish.
TEST(ArmsOfFiles, StandWhereTheirWordsSay) {
    for (std::size_t n = 0; n < property_cases(330) && !HasFailure(); ++n) {
        File file(60'000 + n);
        const auto kind = static_cast<Kind>(n % kinds);
        const auto text = file.write(kind);
        SCOPED_TRACE(::testing::Message() << "arm " << n << '\n' << text);
        axes::Pose tool;
        const auto arm = loaded(text, tool);
        if (!arm) return;
        const double scale = file.group_unit.scale, size = reach + length(of_six(file.base).at) + length(of_six(file.tool).at);
        for (int stand = 0; stand < 8; ++stand) {
            auto q = file.drawn_stand();
            if (stand > 4 && kind >= Kind::wrist) {  // beside the wrist's singularity, where both signs are
                q[4] = (stand % 2 == 0 ? 1 : -1) * std::pow(10.0, -file.uniform(2, 9));
                if (stand == 7) q[2] += 0;
            }
            const auto axes = file.axes_of(q);
            const auto here = arm->forward(axes, tool);
            ASSERT_TRUE(here.miss.ok());
            const auto expected = file.tool_point(axes), found = of_pose(here.pose, scale);
            ASSERT_LE(apart(found, expected), 1e-9 * size) << stand;
            ASSERT_LE(tilt(found, expected), 1e-9) << stand;

            const auto numbers = file.arm.flags(q);
            const auto branch = arm->configuration(axes).branch;
            const auto agrees = [](const std::optional<double>& number, int flag) {
                if (number && std::abs(*number) > 1e-9) {
                    EXPECT_EQ(flag, *number > 0 ? 1 : -1) << *number;
                }
            };
            agrees(numbers.shoulder, static_cast<int>(branch.shoulder));
            agrees(numbers.elbow, static_cast<int>(branch.elbow));
            agrees(numbers.wrist, static_cast<int>(branch.wrist));

            // Back, with the flags that it stands in, from joints that are near.
            if (arm->singularity(axes).measure < 0.02) continue;
            auto near = q;
            for (std::size_t i = 0; i < file.arm.turning.size(); ++i) near[i] += file.uniform(-0.05, 0.05) * (file.arm.turning[i] ? 1 : 20);
            const auto way = arm->inverse(here.pose, tool, arm->configuration(axes), file.axes_of(near));
            ASSERT_TRUE(way.ok()) << axes::name(way.miss.fault) << " " << way.miss.amount << ", stand " << stand;
            ASSERT_LE(apart(file.tool_point(way.axes), expected), 1e-9 * size);
            const auto again = file.joints_of(way.axes);
            for (std::size_t i = 0; i < file.arm.turning.size(); ++i)
                ASSERT_NEAR(again[i], q[i], 1e-6 * (file.arm.turning[i] ? 1 : size)) << "joint " << i + 1 << ", stand " << stand;
            EXPECT_TRUE(axes::answers(arm->configuration(way.axes).branch, branch));
            const auto all = arm->inverse_all(here.pose, tool, axes);
            for (std::size_t i = 0; i < static_cast<std::size_t>(all.count); ++i) {
                ASSERT_LE(apart(file.tool_point(all.at[i].axes), expected), 1e-9 * size);
                ASSERT_LE(tilt(file.tool_point(all.at[i].axes), expected), 1e-9);
            }
        }
    }
}

// Velocities by differences of the formulas above, of sixth order; derivatives of the axes along a path by differences of the inverse, of eighth and sixth
// order.
TEST(ArmsOfFiles, MoveAsTheirDifferencesDo) {
    constexpr std::array<double, 9> first{1.0 / 280, -4.0 / 105, 1.0 / 5, -4.0 / 5, 0, 4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    constexpr std::array<double, 9> second{-1.0 / 560, 8.0 / 315, -1.0 / 5, 8.0 / 5, -205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    constexpr std::array<double, 9> third{-7.0 / 240, 3.0 / 10, -169.0 / 120, 61.0 / 30, 0, -61.0 / 30, 169.0 / 120, -3.0 / 10, 7.0 / 240};
    std::size_t compared = 0;
    for (std::size_t n = 0; n < property_cases(220) && !HasFailure(); ++n) {
        File file(70'000 + n);
        const auto kind = static_cast<Kind>(n % kinds);
        const auto text = file.write(kind);
        SCOPED_TRACE(::testing::Message() << "arm " << n << '\n' << text);
        axes::Pose tool;
        const auto arm = loaded(text, tool);
        if (!arm) return;
        const double scale = file.group_unit.scale;
        const auto q = file.drawn_stand();
        const auto axes = file.axes_of(q);
        const auto here = arm->forward(axes, tool);
        ASSERT_TRUE(here.miss.ok());
        const auto jacobian = arm->jacobian(axes, tool);
        const std::size_t count = file.arm.turning.size();
        for (std::size_t i = 0; i < count; ++i) {
            const double step = (file.arm.turning[i] ? 0.01 : 2) / file.units[i].scale;
            Vec v{}, w{};
            const auto centre = of_pose(here.pose, scale);
            for (int k = -4; k <= 4; ++k) {
                auto there = axes;
                there[i] += k * step;
                const auto at = file.tool_point(there);
                const double part = first[static_cast<std::size_t>(k + 4)] / step;
                for (std::size_t c = 0; c < 3; ++c) v[c] += part * at.at[c];
                // Half the sum of axis x axis'.
                for (std::size_t c = 0; c < 3; ++c) {
                    const auto turn = cross(column(centre, c), column(at, c));
                    for (std::size_t r = 0; r < 3; ++r) w[r] += 0.5 * part * turn[r];
                }
            }
            for (std::size_t c = 0; c < 3; ++c) {
                const auto column_of = static_cast<std::ptrdiff_t>(i), row = static_cast<std::ptrdiff_t>(c);
                const double unit = file.units[i].scale * (file.arm.turning[i] ? reach : 1);
                ASSERT_NEAR(jacobian(row, column_of) * scale, v[c], 1e-8 * unit) << "joint " << i + 1 << ", " << c;
                ASSERT_NEAR(jacobian(row + 3, column_of), w[c], 1e-8 * unit / (file.arm.turning[i] ? 1 : 20))
                    << "joint " << i + 1 << ", turn " << c;
            }
        }

        // A way with a curve in it: by the parameter, in parts of the arm.
        if (arm->singularity(axes).measure < 0.4) continue;  // differences of a root beside its end are none
        axes::PathDerivatives path;
        for (auto& order : path.position)
            for (auto& value : order) value = file.uniform(-100, 100) / scale;
        Vec turning{};
        const bool all_turns = kind >= Kind::wrist;
        const bool level = kind == Kind::scara || kind == Kind::palletizer;
        if (all_turns) turning = {file.uniform(-0.5, 0.5), file.uniform(-0.5, 0.5), file.uniform(-0.5, 0.5)};
        if (level || ((kind == Kind::rotary || kind == Kind::linear || kind == Kind::beam) && file.arm.turns)) {
            const auto up = column(of_six(file.base), 2);
            const double speed = file.uniform(-0.5, 0.5);
            turning = {speed * up[0], speed * up[1], speed * up[2]};
        }
        path.turn[0] = turning;
        const auto found = arm->derivatives(axes, tool, path);
        ASSERT_TRUE(found.miss.ok());
        constexpr double step = 0.005;
        std::array<axes::Joints, 3> differences{};
        bool reached = true;
        auto near = axes;
        for (int k = -4; k <= 4 && reached; ++k) {
            const double s = k * step, angle = length(turning) * s;
            auto pose = here.pose;
            for (std::size_t c = 0; c < 3; ++c)
                pose.position[c] += s * path.position[0][c] + s * s / 2 * path.position[1][c] + s * s * s / 6 * path.position[2][c];
            if (angle != 0) {
                const double l = length(turning), h = angle / 2;
                const std::array<double, 4> t{std::cos(h), std::sin(h) * turning[0] / l, std::sin(h) * turning[1] / l,
                                              std::sin(h) * turning[2] / l};
                const auto& o = here.pose.orientation;
                pose.orientation = {
                    t[0] * o[0] - t[1] * o[1] - t[2] * o[2] - t[3] * o[3], t[0] * o[1] + t[1] * o[0] + t[2] * o[3] - t[3] * o[2],
                    t[0] * o[2] - t[1] * o[3] + t[2] * o[0] + t[3] * o[1], t[0] * o[3] + t[1] * o[2] - t[2] * o[1] + t[3] * o[0]};
            }
            axes::Configuration wanted;
            wanted.branch = arm->configuration(axes).branch;
            const auto way = arm->inverse(pose, tool, wanted, near);
            reached = way.ok();
            const auto at = static_cast<std::size_t>(k + 4);
            for (std::size_t i = 0; i < count; ++i) {
                differences[0][i] += first[at] / step * way.axes[i];
                differences[1][i] += second[at] / (step * step) * way.axes[i];
                differences[2][i] += third[at] / (step * step * step) * way.axes[i];
            }
        }
        if (!reached) continue;
        ++compared;
        for (std::size_t order = 0; order < 3; ++order) {
            double most = 0;
            for (std::size_t i = 0; i < count; ++i) most = std::max(most, std::abs(found.of[order][i]) * file.units[i].scale);
            constexpr std::array<double, 3> share{1e-6, 1e-5, 1e-3}, least{1e-8, 1e-6, 1e-3};
            for (std::size_t i = 0; i < count; ++i)
                ASSERT_NEAR(found.of[order][i] * file.units[i].scale, differences[order][i] * file.units[i].scale,
                            share[order] * most + least[order])
                    << "joint " << i + 1 << ", derivative " << order + 1;
        }
    }
    EXPECT_GT(compared, property_cases(220) / 5);
}

}  // namespace
}  // namespace taktwerk::config
