// The pictures of docs/motion/kinematics.md are drawn from the arms' own formulas, and stand as those draw them today.
// TAKTWERK_REGENERATE=1 writes them.

#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/axes/kinematics/pose_difference.hpp"
#include "tests/axes/kinematics/published_arms.hpp"

namespace taktwerk::axes {
namespace {

using Point = Eigen::Vector3d;
enum class View { side, above };  // x to the right and z up; x to the right and y up

/// A drawing in metres, made into a picture at its end.
class ArmPicture {
public:
    ArmPicture(View view, double left, double right_edge, double low, double high)
        : view_{view}, left_{left}, right_{right_edge}, low_{low}, high_{high} {}

    void line(const std::vector<Point>& points, const std::string& style) {
        std::string path;
        for (const Point& p : points) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(p), y(p));
        body_ += fmt::format("<path d=\"{}\" {}/>\n", path, style);
    }
    void links(const std::vector<Point>& points) {
        line(points, "stroke=\"#1f5fa8\" stroke-width=\"5\" stroke-linecap=\"round\" stroke-linejoin=\"round\" fill=\"none\"");
    }
    void ghost(const std::vector<Point>& points) {
        line(points, "stroke=\"#9bbce0\" stroke-width=\"3\" stroke-linecap=\"round\" stroke-linejoin=\"round\" fill=\"none\"");
    }
    void ground(const std::vector<Point>& points) { line(points, "stroke=\"#666\" stroke-width=\"3\" fill=\"none\""); }
    void joint(const Point& p, const std::string& name) {
        body_ +=
            fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"7\" fill=\"#fff\" stroke=\"#1f5fa8\" stroke-width=\"2\"/>\n", x(p), y(p));
        body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"9\">{}</text>\n", x(p), y(p) + 3, name);
    }
    /// The tool's frame: x red, z (from above: y) blue.
    void frame(const Pose& pose) {
        const Point o = position_of(pose);
        const double size = (right_ - left_) / 12;
        const auto arrow = [&](const Point& direction, const char* colour) {
            line({o, o + orientation_of(pose) * direction * size}, fmt::format("stroke=\"{}\" stroke-width=\"2\"", colour));
        };
        arrow(Point::UnitX(), "#c0392b");
        arrow(view_ == View::side ? Point::UnitZ() : Point::UnitY(), view_ == View::side ? "#2450c0" : "#2a8a3a");
    }
    /// A length, beside the line that it measures.
    void length(const Point& from, const Point& to, const std::string& name) {
        line({from, to}, "stroke=\"#999\" stroke-dasharray=\"3 3\"");
        words((from + to) / 2, name);
    }
    void words(const Point& at, const std::string& text) {
        body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"#333\">{}</text>\n", x(at) + 6, y(at) - 4, text);
    }

    [[nodiscard]] std::string text(const std::string& title) const {
        return fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
            "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<text x=\"10\" y=\"16\" font-weight=\"bold\">{}</text>\n{}</svg>\n",
            width, height(), title, body_);
    }

private:
    static constexpr double width = 420, top = 30;
    [[nodiscard]] double scale() const { return (width - 20) / (right_ - left_); }
    [[nodiscard]] double height() const { return top + 10 + (high_ - low_) * scale(); }
    [[nodiscard]] double x(const Point& p) const { return 10 + (p.x() - left_) * scale(); }
    [[nodiscard]] double y(const Point& p) const { return top + (high_ - (view_ == View::side ? p.z() : p.y())) * scale(); }

    View view_;
    double left_, right_, low_, high_;
    std::string body_;
};

Pose pose_at(const PublishedArm& arm, const Joints& axes) { return made(arm).forward(axes, {}).pose; }

/// Origins of the joints' frames at these angles of the arm's own.
std::vector<Point> origins(const JointChain& chain, const Joints& angles) {
    std::vector<Point> points;
    for (const Frame<double>& f : chain.frames(angles)) points.push_back(vector_of(f.origin));
    return points;
}

std::string six_joints_with_wrist() {
    const WristArmLengths l{.a1 = .070, .a2 = -.050, .c1 = .352, .c2 = .360, .c3 = .380, .c4 = .065};
    const JointChain chain = chain_of(l);
    const auto skeleton = [&](const Joints& q) {
        std::vector<Point> p = origins(chain, q);
        // Past axis 3 the offset first, then along the forearm.
        const Frame<double> elbow = [&] {
            Frame<double> f = chain.frames(q)[2];
            f.turn(2, q[2]);
            return f;
        }();
        const Point corner = vector_of(elbow.origin) + l.a2 * vector_of(elbow.axis[0]);
        return std::vector<Point>{p[0], {p[0].x(), p[0].y(), p[1].z()}, p[1], p[2], corner, p[3], p[6]};
    };
    ArmPicture picture{View::side, -.35, 1.05, -.05, 1.3};
    picture.ground({{-.15, 0, 0}, {.25, 0, 0}});
    const Joints up{}, level{0, 0, right, 0, 0, 0}, bent{0, .6, 1.4, 0, .7, 0};
    picture.ghost(skeleton(level));
    picture.ghost(skeleton(bent));
    const std::vector<Point> p = skeleton(up);
    picture.links(p);
    picture.joint({0, 0, .12}, "1");
    picture.joint(p[2], "2");
    picture.joint(p[3], "3");
    picture.joint({p[4].x(), 0, p[4].z() + .15}, "4");
    picture.joint(p[5], "5");
    picture.joint(p[6] - Point{0, 0, .02}, "6");
    picture.length({-.1, 0, 0}, {-.1, 0, l.c1}, "c1");
    picture.words({l.a1 - .02, 0, l.c1 - .07}, "a1");
    picture.length({-.1, 0, l.c1}, {-.1, 0, l.c1 + l.c2}, "c2");
    picture.length({-.1, 0, l.c1 + l.c2}, {-.1, 0, l.c1 + l.c2 + l.c3}, "c3");
    picture.length({-.1, 0, p[5].z()}, {-.1, 0, p[6].z()}, "c4");
    picture.words({p[3].x(), 0, p[3].z() + .015}, "a2 &lt; 0");
    const PublishedArm arm{"", with_wrist(l, all_joints(1), {}), {}, {}};
    for (const Joints& q : {up, level, bent}) picture.frame(pose_at(arm, q));
    return picture.text("wrist arm at 0, straight up; pale: bent forward");
}

std::string three_parallel_axes() {
    const JointChain chain = chain_of(ur5e_table().rows, DhConvention::classic);
    ArmPicture picture{View::side, -.95, .45, -.1, 1.15};
    picture.ground({{-.15, 0, 0}, {.15, 0, 0}});
    const Joints zero{}, bent = degrees({0, -110, 80, -60, -90, 0});
    picture.ghost(origins(chain, bent));
    const std::vector<Point> p = origins(chain, zero);
    std::vector<Point> whole{{0, 0, 0}};
    whole.insert(whole.end(), p.begin(), p.end());
    picture.links(whole);
    picture.joint({0, 0, .05}, "1");
    for (std::size_t i = 1; i < 4; ++i) picture.joint(p[i], fmt::format("{}", i + 1));
    picture.joint(p[4], "5");
    picture.words({-.25, 0, .19}, "a2");
    picture.words({-.65, 0, .19}, "a3");
    picture.words({.03, 0, .08}, "d1");
    picture.words({-.81, 0, .1}, "d5");
    picture.frame(pose_at(ur5e(), zero));
    picture.frame(pose_at(ur5e(), bent));
    return picture.text("three parallel axes at 0; pale: bent");
}

std::string scara() {
    const PublishedArm arm = epson_g10();
    ArmPicture picture{View::above, -.3, .75, -.35, .7};
    const auto skeleton = [](double first, double second) {
        const Point elbow{.25 * std::cos(first), .25 * std::sin(first), 0};
        return std::vector<Point>{{0, 0, 0}, elbow, elbow + Point{.4 * std::cos(first + second), .4 * std::sin(first + second), 0}};
    };
    const Joints up = degrees({10, 60, 0, 0, 0, 0});
    // The same point with the elbow on the other side.
    Configuration down;
    down.branch.elbow = Elbow::down;
    const Joints mirrored = made(arm).inverse(pose_at(arm, up), {}, down, {}).axes;
    picture.ghost(skeleton(0, 0));
    picture.ghost(skeleton(mirrored[0], mirrored[1]));
    const std::vector<Point> p = skeleton(up[0], up[1]);
    picture.links(p);
    picture.joint(p[0], "1");
    picture.joint(p[1], "2");
    picture.joint(p[2], "4");
    picture.words((p[0] + p[1]) / 2 + Point{0, -.05, 0}, "first");
    picture.words((p[1] + p[2]) / 2, "second");
    picture.words(skeleton(0, 0)[2] + Point{-.15, .01, 0}, "at 0");
    picture.words(skeleton(mirrored[0], mirrored[1])[1], "down");
    picture.words(p[1] + Point{.03, 0, 0}, "up");
    picture.frame(pose_at(arm, up));
    picture.frame(pose_at(arm, {}));
    return picture.text("SCARA from above: elbow up, down, and the zero pose");
}

std::string palletizer() {
    const PublishedArm arm = irb_460();
    const auto skeleton = [](double upper, double fore) {
        const Point shoulder{.260, 0, .745}, elbow = shoulder + .945 * Point{std::sin(upper), 0, std::cos(upper)};
        const Point wrist = elbow + 1.025 * Point{std::cos(fore), 0, -std::sin(fore)};
        return std::vector<Point>{
            {0, 0, 0}, {0, 0, .745}, shoulder, elbow, wrist, wrist + Point{.225, 0, 0}, wrist + Point{.225, 0, -.2515}};
    };
    ArmPicture picture{View::side, -.4, 2.3, -.1, 2.1};
    picture.ground({{-.3, 0, 0}, {.4, 0, 0}});
    const Joints bent = degrees({0, 40, 50, 0, 0, 0});
    picture.ghost(skeleton(bent[1], bent[2]));
    const std::vector<Point> p = skeleton(0, 0);
    picture.links(p);
    picture.joint({0, 0, .3}, "1");
    picture.joint(p[2], "2");
    picture.joint(p[3], "3");
    picture.joint(p[6], "4");
    picture.words({.02, 0, .5}, "height");
    picture.words({.06, 0, .78}, "shoulder");
    picture.words({.28, 0, 1.2}, "upper");
    picture.words({.7, 0, 1.72}, "fore");
    picture.words({1.3, 0, 1.72}, "wrist");
    picture.words({1.53, 0, 1.55}, "drop");
    picture.frame(pose_at(arm, {}));
    picture.frame(pose_at(arm, bent));
    return picture.text("palletizer at 0; pale: 40 and 50 degrees at 2 and 3");
}

std::string rotary_delta() {
    const PublishedArm arm = flexpicker();
    ArmPicture picture{View::side, -.65, .75, -1.2, .15};
    const auto draw = [&](const Joints& q, const std::function<void(const std::vector<Point>&)>& links) {
        const Pose platform = pose_at(arm, q);
        for (std::size_t i = 0; i < 3; ++i) {
            const double angle = 120 * degree * static_cast<double>(i);
            const Point out{std::cos(angle), std::sin(angle), 0};
            const Point elbow = out * (.200 + .3545 * std::cos(q[i])) - Point{0, 0, .3545 * std::sin(q[i])};
            links({Point{0, 0, 0}, out * .200, elbow, position_of(platform) + out * .052, position_of(platform)});
        }
        picture.frame(platform);
    };
    const Joints low = degrees({60, 20, 45, 0, 0, 0});
    draw(low, [&](const auto& p) { picture.ghost(p); });
    draw({}, [&](const auto& p) { picture.links(p); });
    picture.ground({{-.25, 0, .02}, {.25, 0, .02}});
    picture.joint({.2, 0, 0}, "1");
    picture.words({.05, 0, .03}, "base_radius");
    picture.words({.35, 0, 0}, "upper");
    picture.words({.35, 0, -.3}, "rod");
    picture.words({.03, 0, -.62}, "platform_radius");
    return picture.text("rotary delta at 0 from the side; pale: 60, 20, 45 degrees");
}

std::string linear_delta_picture() {
    const PublishedArm arm = linear_delta();
    ArmPicture picture{View::side, -.25, .25, -.03, .5};
    const auto draw = [&](const Joints& q, const std::function<void(const std::vector<Point>&)>& links) {
        const Pose platform = pose_at(arm, q);
        for (std::size_t i = 0; i < 3; ++i) {
            const double angle = (210 + 120 * static_cast<double>(i)) * degree;
            const Point out{std::cos(angle), std::sin(angle), 0};
            links({out * .1615 + Point{0, 0, q[i]}, position_of(platform) + out * .033, position_of(platform)});
        }
        picture.frame(platform);
    };
    for (int i = 0; i < 3; ++i) {
        const double angle = (210 + 120 * i) * degree;
        picture.ground({{.1615 * std::cos(angle), 0, 0}, {.1615 * std::cos(angle), 0, .45}});
        picture.words({.1615 * std::cos(angle), 0, .43}, fmt::format("{}", i + 1));
    }
    const Joints up{.4, .4, .4, 0, 0, 0}, low{.25, .33, .3, 0, 0, 0};
    draw(low, [&](const auto& p) { picture.ghost(p); });
    draw(up, [&](const auto& p) { picture.links(p); });
    picture.words({.07, 0, .25}, "rod");
    return picture.text("linear delta from the side, carriages alike; pale: not alike");
}

std::string beam_gantry_picture() {
    ArmPicture picture{View::above, -.4, 4.2, -.4, 2.9};
    picture.ground({{-.2, 0, 0}, {4, 0, 0}});
    picture.ground({{-.2, 2.4, 0}, {4, 2.4, 0}});
    const auto draw = [&](const Joints& q, const std::function<void(const std::vector<Point>&)>& links) {
        links({{q[0], 0, 0}, {q[1], 2.4, 0}});
        picture.frame(pose_at(beam_gantry(), q));
    };
    draw({2.6, 3.2, 1.6, 0, 0, 0}, [&](const auto& p) { picture.ghost(p); });
    draw({1, 1, .8, 0, 0, 0}, [&](const auto& p) { picture.links(p); });
    picture.joint({1, 0, 0}, "1");
    picture.joint({1, 2.4, 0}, "2");
    picture.joint({1, .8, 0}, "3");
    picture.length({-.1, 0, 0}, {-.1, 2.4, 0}, "span");
    picture.length({2.6, 2.5, 0}, {3.2, 2.5, 0}, "skew");
    return picture.text("beam gantry from above, square; pale: skewed");
}

struct Drawn {
    std::string file;
    std::string (*draw)();
};

class ArmPictures : public ::testing::TestWithParam<Drawn> {};

TEST_P(ArmPictures, StandAsTheArmsDrawThem) {
    const std::string path = std::string(TAKTWERK_SOURCE_DIR) + "/docs/motion/figures/" + GetParam().file, drawn = GetParam().draw();
    if (std::getenv("TAKTWERK_REGENERATE") != nullptr) std::ofstream(path) << drawn;
    std::ostringstream stored;
    stored << std::ifstream(path).rdbuf();
    EXPECT_EQ(stored.str(), drawn) << "TAKTWERK_REGENERATE=1 writes it again";
}

INSTANTIATE_TEST_SUITE_P(Kinematics, ArmPictures,
                         ::testing::Values(Drawn{"arm-wrist.svg", six_joints_with_wrist}, Drawn{"arm-parallel.svg", three_parallel_axes},
                                           Drawn{"arm-scara.svg", scara}, Drawn{"arm-palletizer.svg", palletizer},
                                           Drawn{"arm-rotary-delta.svg", rotary_delta}, Drawn{"arm-linear-delta.svg", linear_delta_picture},
                                           Drawn{"arm-beam-gantry.svg", beam_gantry_picture}),
                         [](const auto& info) {
                             std::string name;
                             for (const char c : info.param.file.substr(0, info.param.file.find('.')))
                                 if (c != '-') name += c;
                             return name;
                         });

}  // namespace
}  // namespace taktwerk::axes
