#include "config/machine_file/cam_tables.hpp"

#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "axes/tables/cam_check.hpp"
#include "config/machine_file/cam_file.hpp"
#include "config/reading/codecs.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::config {

namespace {

using axes::CamPoint;
using axes::CamSegment;

CamUnits units_of(const Reader& reader) { return {reader.master_unit, reader.axis_unit}; }

/// A position of the master; one of the slave is `quantity(Dimension::position)`, since a cam is read in the slave's unit.
Codec<double> master_position() {
    auto c = quantity(Dimension::position);
    c.read = [read = std::move(c.read)](Reader& reader, const Node& node, double& out) {
        std::swap(reader.axis_unit, reader.master_unit);
        const bool good = read(reader, node, out);
        std::swap(reader.axis_unit, reader.master_unit);
        return good;
    };
    return c;
}

Codec<double> derivative(int order) {
    Codec<double> c;
    c.shape.kind = Shape::Kind::either;
    c.shape.alternatives = {std::make_shared<const Shape>(text().shape), std::make_shared<const Shape>(number().shape)};
    c.read = [order](Reader& reader, const Node& node, double& out) {
        const auto units = units_of(reader);
        const auto value = node.kind == Node::Kind::scalar ? parse_cam_derivative(node.text, order, units) : std::nullopt;
        if (value) out = *value;
        else
            report_wrong_type(reader, node, fmt::format("a number in {}", unit_of_cam_derivative(order, units)),
                              fmt::format("0.5 {}", unit_of_cam_derivative(order, units)));
        return value.has_value();
    };
    return c;
}

Codec<CamSegment> law() {
    return choice<CamSegment>({{"straight_line", CamSegment::linear},
                               {"quadratic_parabola", CamSegment::quadratic_parabola},
                               {"simple_sine", CamSegment::simple_sine},
                               {"inclined_sine", CamSegment::inclined_sine},
                               {"polynomial_5", CamSegment::quintic},
                               {"modified_trapezoid", CamSegment::modified_trapezoid},
                               {"modified_sine", CamSegment::modified_sine},
                               {"harmonic_combination", CamSegment::harmonic_combination},
                               {"spline", CamSegment::spline}});
}

Table<CamPointEntry> point_table() {
    using P = CamPointEntry;
    Table<P> table{
        "cams.<name>.points",
        "A point, and the law by which the cam goes on from it.",
        {
            required(field_at<P>(
                "master", [](P & p) -> auto& { return p.point.master; }, master_position(),
                "position of the master, in its unit; it rises from point to point")),
            required(field_at<P>(
                "slave", [](P & p) -> auto& { return p.point.slave; }, quantity(Dimension::position), "position of the slave")),
            with_default(field("velocity", &P::velocity, maybe(derivative(1)),
                               "of the slave over the master: `0.5 mm/deg`; where both have one unit also a bare number"),
                         "that of a straight line beside the point, else 0"),
            with_default(field_at<P>(
                             "acceleration", [](P & p) -> auto& { return p.point.acceleration; }, derivative(2),
                             "of the slave over the master, `0.1 mm/deg2`: of `polynomial_5`, and where "
                             "`harmonic_combination` turns back"),
                         "0"),
            with_default(field("law", &P::law, maybe(law()), "how the cam goes on from here to the next point"), "`law` of the cam"),
        },
        [](Reader& reader, const Node& node, P& p) { p.place = located(reader.file(), node.at); },
        {}};
    return table;
}

/// Points without units that are known would only add to what is wrong with the axes.
Codec<std::vector<CamPointEntry>> points() {
    auto c = list(section(point_table()));
    c.read = [read = std::move(c.read)](Reader& reader, const Node& node, std::vector<CamPointEntry>& out) {
        return reader.master_unit.empty() || reader.axis_unit.empty() || read(reader, node, out);
    };
    return c;
}

/// The name of an axis, and `unit` becomes its unit; empty where there is no such axis.
Codec<std::string> axis_with(std::string Reader::*unit) {
    auto c = name();
    c.read = [unit, read = std::move(c.read)](Reader& reader, const Node& node, std::string& out) {
        (reader.*unit).clear();
        if (!read(reader, node, out)) return false;
        const auto found = reader.units_of_axes.find(out);
        if (found != reader.units_of_axes.end()) {
            reader.*unit = found->second;
            return true;
        }
        if (reader.already_bad("axes")) return false;
        std::vector<std::string> names;
        std::string all;
        for (const auto& [axis, unused] : reader.units_of_axes) {
            names.push_back(axis);
            all += (all.empty() ? "" : ", ") + axis;
        }
        const auto near = nearest_name(out, names);
        reader.problem(node.at, "config.unknown_axis", fmt::format("there is no axis '{}' (there is: {})", out, all.empty() ? "none" : all),
                       near.empty() ? "correct the name, or add it to `axes`" : fmt::format("did you mean `{}`?", near));
        return false;
    };
    return c;
}

// --- over all points --------------------------------------------------------------------------------------------------------

/// The slope of the straight line that ends or begins at a point.
std::optional<double> straight_beside(const std::vector<CamPointEntry>& points, std::size_t i) {
    const auto slope = [&](std::size_t k) {
        return (points[k + 1].point.slave - points[k].point.slave) / (points[k + 1].point.master - points[k].point.master);
    };
    if (i + 1 < points.size() && points[i].point.segment == CamSegment::linear) return slope(i);
    if (i > 0 && points[i - 1].point.segment == CamSegment::linear) return slope(i - 1);
    return std::nullopt;
}

/// Of measured velocities: the slope of the parabola through three of them, exact where the acceleration changes evenly.
void derive_accelerations(std::vector<CamPointEntry>& points, bool periodic) {
    const std::size_t last = points.size() - 1;
    const auto m = [&](std::size_t i) { return points[i].point.master; };
    const auto v = [&](std::size_t i) { return points[i].point.velocity; };
    if (last < 2) {
        for (auto& p : points) p.point.acceleration = (v(1) - v(0)) / (m(1) - m(0));
        return;
    }
    const auto slope_at = [](double h0, double h1, double s0, double s1) { return (h1 * s0 + h0 * s1) / (h0 + h1); };
    for (std::size_t i = 1; i < last; ++i) {
        const double h0 = m(i) - m(i - 1), h1 = m(i + 1) - m(i);
        points[i].point.acceleration = slope_at(h0, h1, (v(i) - v(i - 1)) / h0, (v(i + 1) - v(i)) / h1);
    }
    const double first = m(1) - m(0), final = m(last) - m(last - 1);
    const double s_first = (v(1) - v(0)) / first, s_final = (v(last) - v(last - 1)) / final;
    auto &begin = points.front().point, &end = points.back().point;
    if (periodic) {
        begin.acceleration = end.acceleration = slope_at(final, first, s_final, s_first);
    } else {
        begin.acceleration = 2 * s_first - points[1].point.acceleration;
        end.acceleration = 2 * s_final - points[last - 1].point.acceleration;
    }
}

class Completion {
public:
    Completion(Reader& reader, const Node& node, CamEntry& entry) : reader_(reader), node_(node), entry_(entry) {}

    void run() {
        const bool has_points = node_.find("points") != nullptr, has_file = node_.find("file") != nullptr;
        if (has_points && has_file)
            return reader_.problem(node_.at, "config.conflict", fmt::format("`{}` has both `points` and `file`", reader_.path()),
                                   "keep one of them");
        if (!has_points && !has_file)
            return reader_.problem(node_.at, "config.missing_key", fmt::format("`{}` has neither `points` nor `file`", reader_.path()),
                                   "add `points:` or `file:`");
        if (reader_.already_bad(reader_.path()) || reader_.master_unit.empty() || reader_.axis_unit.empty()) return;
        if (has_file && !read_file()) return;
        if (has_points && !points_are_good()) return;
        fill_in();
        refuse_misfits();
        remark_steps();
    }

private:
    [[nodiscard]] std::vector<CamPointEntry>& points() { return entry_.points; }

    bool read_file() {
        std::filesystem::path path(entry_.file);
        if (path.is_relative()) path = (std::filesystem::path(reader_.file()).parent_path() / path).lexically_normal();
        const auto& at = node_.find("file")->at;
        auto file = read_cam_file(path.string(), units_of(reader_));
        for (auto& error : file.errors) {
            if (error.subject == path.string()) {  // the whole file: the place is where it is named
                error.what = fmt::format("{}: {}", path.string(), error.what);
                error.subject = located(reader_.file(), at);
            }
            reader_.errors().push_back(std::move(error));
        }
        if (!file.errors.empty()) {
            reader_.mark_bad(reader_.path());
            return false;
        }
        velocities_ = file.velocities;
        for (std::size_t i = 0; i < file.points.size(); ++i)
            points().push_back({file.points[i], file.velocities ? std::optional(file.points[i].velocity) : std::nullopt, std::nullopt,
                                located(path.string(), {file.lines[i], 1})});
        if (!entry_.law) entry_.law = file.velocities ? CamSegment::quintic : CamSegment::spline;
        return true;
    }

    bool points_are_good() {
        if (points().size() < 2 || points().size() > max_cam_points) {
            reader_.problem(node_.find("points")->at, "config.cam_points",
                            fmt::format("`{}` has {} points", reader_.path(), points().size()),
                            fmt::format("a cam has 2 to {} points", max_cam_points));
            return false;
        }
        for (std::size_t i = 1; i < points().size(); ++i) {
            const double before = points()[i - 1].point.master, here = points()[i].point.master;
            if (here > before) continue;
            const auto& item = node_.find("points")->items[i];
            reader_.problem(item.find("master")->at, "config.cam_order",
                            fmt::format("the master's position {} {} is not above that of the point before, {}", show_number(here),
                                        reader_.master_unit, show_number(before)),
                            "list the points by the master's position, and give each once");
            return false;
        }
        return true;
    }

    void fill_in() {
        for (auto& p : points()) p.point.segment = p.law.value_or(entry_.law.value_or(CamSegment::quintic));
        for (std::size_t i = 0; i < points().size(); ++i)
            points()[i].point.velocity = points()[i].velocity.value_or(straight_beside(points(), i).value_or(0));
        if (entry_.cam.periodic) close();
        if (velocities_ && entry_.law == CamSegment::quintic) derive_accelerations(points(), entry_.cam.periodic);
        auto& out = entry_.cam.points;
        for (const auto& p : points()) out.push_back(p.point);
    }

    /// The first and the last point of a periodic cam are one.
    void close() {
        auto &first = points().front(), &last = points().back();
        const auto take = [](CamPointEntry& to, const CamPointEntry& from, bool known) {
            if (!to.velocity && known) to.point.velocity = from.point.velocity;
        };
        take(last, first, first.velocity || first.point.segment == CamSegment::linear);
        take(first, last, last.velocity || points()[points().size() - 2].point.segment == CamSegment::linear);
    }

    void refuse_misfits() {
        for (const auto i : axes::misfits_of(entry_.cam.points)) {
            const bool harmonic = points()[i].point.segment == CamSegment::harmonic_combination;
            reader_.errors().push_back(
                {"config.cam_law", points()[i].place,
                 harmonic
                     ? "the harmonic combination cannot get from here to the next point: it turns back at a point with an acceleration and "
                       "no "
                       "velocity, towards the side it comes from, and no more gently than pi^2/4 of the way over the square of the width"
                     : "the law cannot join this point and the next one: they lie too close together",
                 harmonic ? "give the turning point a larger `acceleration` of the right sign, or take `law: polynomial_5`"
                          : "move the points apart"});
            reader_.mark_bad(reader_.path());
        }
    }

    void remark_steps() {
        const auto units = units_of(reader_);
        const auto steps = axes::steps_of(entry_.cam.points, entry_.cam.periodic);
        constexpr std::size_t most = 3;
        for (std::size_t i = 0; i < std::min(steps.size(), most); ++i) {
            const auto& step = steps[i];
            const bool velocity = step.of == axes::CamStep::Of::velocity;
            const int order = velocity ? 1 : 2;
            const auto where = step.point == 0
                                   ? "where its end runs into its beginning"
                                   : fmt::format("at master {} {}", show_number(points()[step.point].point.master), units.master);
            const auto more = i + 1 == most && steps.size() > most ? fmt::format("; {} more like it", steps.size() - most) : "";
            entry_.remarks.push_back(
                {velocity ? "config.cam_velocity_step" : "config.cam_acceleration_step", points()[step.point].place,
                 fmt::format("cam '{}': {} the {} steps from {} to {} {}{}", entry_.cam.name, where, velocity ? "velocity" : "acceleration",
                             rounded(step.before), rounded(step.behind), unit_of_cam_derivative(order, units), more),
                 velocity
                     ? "leave `velocity` out beside a straight line, give the same one to both sides, or put a law with velocity 0 in "
                       "between: "
                       "no slave can follow a step"
                     : "take a law that begins and ends without acceleration (inclined_sine, modified_sine, modified_trapezoid), or give "
                       "polynomial_5 the `acceleration` of its neighbour: a step excites vibration"});
        }
    }
    static std::string rounded(double value) { return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0.0 : value); }

    Reader& reader_;
    const Node& node_;
    CamEntry& entry_;
    bool velocities_ = false;
};

}  // namespace

Table<CamEntry> cam_table() {
    using C = CamEntry;
    return {
        "cams.<name>",
        "A cam by the name that programs ask for (`d.cam(\"name\")`): the slave's position over the master's. The laws are those of VDI "
        "2143: "
        "docs/motion/cam-laws.md.",
        {
            required(field_at<C>(
                "master", [](C & c) -> auto& { return c.cam.master; }, axis_with(&Reader::master_unit),
                "axis in whose unit the master's positions are")),
            required(field_at<C>(
                "slave", [](C & c) -> auto& { return c.cam.slave; }, axis_with(&Reader::axis_unit),
                "axis in whose unit the slave's positions are")),
            field_at<C>(
                "periodic", [](C & c) -> auto& { return c.cam.periodic; }, boolean(),
                "it is repeated (`Periodic` of MC_CamTableSelect): its end is compared with its beginning as well"),
            with_default(field("law", &C::law, maybe(law()), "of every point that names none"),
                         "`polynomial_5`; of a file without velocities `spline`"),
            with_default(field("points", &C::points, points(), "2 to 4096 points"), ""),
            with_default(field("file", &C::file, text(),
                               "or a CSV file with them, relative to this file: a line `master [deg], slave [mm]`, where it is known with "
                               "`velocity [mm/deg]`, then numbers"),
                         ""),
        },
        [](Reader& reader, const Node&, C&) {
            reader.master_unit.clear();
            reader.axis_unit.clear();
        },
        [](Reader& reader, const Node& node, C& c) { Completion(reader, node, c).run(); }};
}

}  // namespace taktwerk::config
