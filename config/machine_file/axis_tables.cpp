#include "config/machine_file/axis_tables.hpp"

#include <fmt/format.h>

#include "axes/axis/command_details.hpp"
#include "config/machine_file/analog_tables.hpp"
#include "config/machine_file/axis_mechanics_tables.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

using axes::AxisConfig;
using runtime::AxisBinding;
using runtime::AxisSimulation;
using Interval = std::pair<double, double>;

Table<axes::Gearing> gearing_table() {
    using G = axes::Gearing;
    return {
        "gearing",
        "How the drive's counts become the axis' unit: counts = position / feed * gear * counts_per_revolution.",
        {
            required(field("counts_per_revolution", &G::counts_per_revolution, integer<std::int64_t>(1, 1LL << 31),
                           "position counts of the drive per motor revolution (encoder resolution, or microsteps)")),
            field_via<G>(
                "gear", fraction(), [](G& g, const Fraction& f) { g.motor_revolutions = f.numerator, g.load_revolutions = f.denominator; },
                "motor revolutions per load revolutions: 5/1 is a gear box that divides by five", "1/1"),
            required(
                field("feed", &G::feed, quantity(Dimension::position), "way per load revolution: pitch of the screw, 360 deg of a table")),
            field("inverted", &G::inverted, boolean(), "true: positive is against the motor's positive sense"),
        },
        {},
        {}};
}

Table<axes::DirectionLimits> direction_table(std::string title, std::string_view torque) {
    using D = axes::DirectionLimits;
    constexpr std::string_view as_both = "as in both";
    Table<D> table{
        std::move(title),
        "What holds in this direction only, as where a weight helps or hinders. Nothing here may be more than what holds in both.",
        {
            with_default(field("velocity", &D::velocity, quantity(Dimension::velocity, 0), "highest velocity"), std::string{as_both}),
            with_default(field("acceleration", &D::acceleration, quantity(Dimension::acceleration, 0),
                               "highest acceleration, while the axis gets faster in this direction"),
                         std::string{as_both}),
            with_default(field("deceleration", &D::deceleration, quantity(Dimension::acceleration, 0),
                               "highest deceleration, while it gets slower in it"),
                         std::string{as_both}),
            with_default(field("torque", &D::torque, number(axes::TorqueLimitDetails::least, 10), std::string{torque}),
                         std::string{as_both}),
        },
        {},
        {}};
    // In the plain data 0 stands for "as in both": written, it is meant to forbid a direction.
    table.after = [](Reader& reader, const Node& node, D& d) {
        for (const auto& [key, value] :
             {std::pair{"velocity", d.velocity}, std::pair{"acceleration", d.acceleration}, std::pair{"deceleration", d.deceleration}})
            if (const auto* found = node.find(key);
                found != nullptr && value == 0 && !reader.already_bad(fmt::format("{}.{}", reader.path(), key)))
                reader.problem(found->at, "config.out_of_range", fmt::format("`0` for `{}.{}` is out of range", reader.path(), key),
                               "give more than 0; a direction is forbidden by MC_Power (EnablePositive, EnableNegative)");
    };
    return table;
}

Table<axes::AxisLimits> limits_table() {
    using L = axes::AxisLimits;
    Table<L> table{
        "limits",
        "What no motion of the axis ever exceeds.",
        {
            required(field("velocity", &L::velocity, quantity(Dimension::velocity), "highest velocity")),
            required(field("acceleration", &L::acceleration, quantity(Dimension::acceleration), "highest acceleration")),
            with_default(field("deceleration", &L::deceleration, quantity(Dimension::acceleration), "highest deceleration"),
                         "= acceleration"),
            required(field("jerk", &L::jerk, quantity_or_none(Dimension::jerk), "highest jerk; `none` for ramps with corners")),
            with_default(
                field("stop_deceleration", &L::stop_deceleration, quantity(Dimension::acceleration), "for errors and emergency stop"),
                "= deceleration"),
            with_default(field("stop_jerk", &L::stop_jerk, quantity_or_none(Dimension::jerk), "for errors and emergency stop"), "= jerk"),
            field_via<L>(
                "position", interval(Dimension::position),
                [](L& l, const Interval& v) { l.position_min = v.first, l.position_max = v.second; },
                "software limits, active once the axis is homed", "none"),
            with_default(field("torque", &L::torque, number(axes::TorqueLimitDetails::least, 10),
                               "highest torque of the drive, as a fraction of the rated one (6072h, or 60E0h and 60E1h); MC_SetTorqueLimit "
                               "stays below it"),
                         "what the drive has"),
            field("positive", &L::positive, section(direction_table("positive", "highest torque in positive direction")),
                  "tighter limits in positive direction"),
            field("negative", &L::negative, section(direction_table("negative", "highest torque in negative direction, without sign")),
                  "tighter limits in negative direction"),
        },
        {},
        {}};
    table.after = [](Reader&, const Node& node, L& l) {
        if (!node.find("deceleration")) l.deceleration = l.acceleration;
    };
    return table;
}

Table<AxisConfig> following_table() {
    return {
        "following_error",
        "When the axis is too far from where it should be.",
        {
            required(field_at<AxisConfig>(
                "window", [](AxisConfig& a) -> double& { return a.following.window; }, quantity_or_none(Dimension::position),
                "largest difference between set-point and actual position, dead time taken into account")),
            field_at<AxisConfig>(
                "time", [](AxisConfig& a) -> Duration& { return a.following.time; }, duration(), "beyond the window for this long: alarm"),
            field_at<AxisConfig>(
                "per_velocity", [](AxisConfig& a) -> Duration& { return a.following.per_velocity; },
                duration(Duration::zero(), axes::FollowingErrorWatch::most_per_velocity),
                "the window is wider by the set velocity times this: what the motor is behind at a steady velocity"),
        },
        {},
        {}};
}

Table<axes::PositionWindows> in_position_table() {
    using W = axes::PositionWindows;
    return {"in_position",
            "When a motion counts as finished on the axis itself.",
            {
                field("window", &W::in_position, quantity(Dimension::position), "largest distance from the target"),
                field("time", &W::in_position_time, duration(), "inside the window for this long"),
                field("standstill_velocity", &W::standstill_velocity, quantity(Dimension::velocity), "slower than this counts as standing"),
            },
            {},
            {}};
}

Table<axes::CodedMarks> marks_table() {
    using M = axes::CodedMarks;
    return {
        "marks",
        "A scale with distance-coded reference marks, in counts of the drive.",
        {
            required(field("spacing", &M::spacing, integer<std::int64_t>(4, 1LL << 31), "between two fixed marks")),
            required(field("step", &M::step, integer<std::int64_t>(1, 1LL << 31), "by which one gap between marks differs from the next")),
        },
        {},
        {}};
}

Table<axes::PositionMemory> memory_table() {
    using E = axes::PositionMemory;
    return {"position_memory",
            "What the encoder knows after power was off.",
            {
                field("absolute", &E::absolute, boolean(),
                      "it keeps its position: the axis loses its reference neither with the bus nor, with `retain`, with power"),
                with_default(field("range", &E::range, integer<std::int64_t>(1, std::int64_t{1} << 53),
                                   "counts after which its position begins anew: turns it can count times counts per turn"),
                             "that of the drive's position, 2^32 mostly"),
                field("moved_while_off", &E::moved_while_off, quantity(Dimension::position, 0),
                      "moved further than this without power, the axis must be homed again"),
            },
            {},
            {}};
}

Table<axes::HomingConfig> homing_table() {
    using H = axes::HomingConfig;
    using Kind = axes::HomingKind;
    Table<H> table{
        "homing",
        "How the axis finds its reference.",
        {
            required(field(
                "kind", &H::kind,
                choice<Kind>({{"none", Kind::none},
                              {"drive", Kind::drive},
                              {"home_switch", Kind::home_switch},
                              {"limit_switch", Kind::limit_switch},
                              {"block", Kind::block},
                              {"reference_pulse", Kind::reference_pulse},
                              {"absolute", Kind::absolute},
                              {"set_here", Kind::set_here}}),
                "drive: the drive's own method · by the runtime: home_switch · limit_switch, back to its edge · block: against a fixed "
                "stop · reference_pulse: home switch, then on to the encoder's index · absolute: the encoder's zero, no motion · "
                "set_here: where it stands · none: MC_Home is refused")),
            with_default(field("method", &H::method, integer<std::int8_t>(-128, 127), "kind drive: number of the method (6098h)"), ""),
            field("search_velocity", &H::search_velocity, quantity(Dimension::velocity, 0), "to the switch"),
            field("latch_velocity", &H::latch_velocity, quantity(Dimension::velocity, 0), "to its edge, slowly"),
            field("acceleration", &H::acceleration, quantity(Dimension::acceleration, 0), "while homing"),
            field("offset", &H::offset, quantity(Dimension::position), "coordinate of the reference where MC_Home gives none"),
            field("direction", &H::negative, choice<bool>({{"negative", true}, {"positive", false}}),
                  "by the runtime: where the search starts"),
            field("timeout", &H::timeout, duration(std::chrono::milliseconds{1}), "homing that takes longer has failed"),
            with_default(field("torque", &H::torque, number(0, 10), "kind block: torque at the stop, as a fraction of the rated one"), ""),
            field("block_velocity", &H::block_velocity, quantity(Dimension::velocity, 0), "kind block: slower than this it is at the stop"),
            field("block_time", &H::block_time, duration(), "kind block: torque and standstill last so long"),
            field("marks", &H::marks, section(marks_table()), "for MC_StepDistanceCoded"),
        },
        {},
        {}};
    table.after = [](Reader& reader, const Node& node, H& h) {
        if (h.kind == Kind::drive && !node.find("method"))
            reader.problem(node.at, "config.missing_key", fmt::format("`{}` lacks its key `method`: the drive has several", reader.path()),
                           "add `method:` with the number from the drive's manual, such as `method: 17`");
    };
    return table;
}

Table<axes::ManualSpeeds> manual_table() {
    using M = axes::ManualSpeeds;
    return {"manual",
            "Speeds under the operator's hand.",
            {
                with_default(field("slow", &M::slow, quantity(Dimension::velocity, 0), "jogging, slow"), "5 % of the limit"),
                with_default(field("fast", &M::fast, quantity(Dimension::velocity, 0), "jogging, fast"), "25 % of the limit"),
                with_default(
                    field("setup_velocity", &M::setup_velocity, quantity(Dimension::velocity, 0), "no motion is faster in set-up mode"),
                    "= slow"),
            },
            {},
            {}};
}

Table<axes::AxisDefaults> defaults_table() {
    using D = axes::AxisDefaults;
    return {"defaults",
            "What a motion block uses where its pin is 0.",
            {
                with_default(field("acceleration", &D::acceleration, quantity(Dimension::acceleration, 0), "acceleration"), "the limit"),
                with_default(field("deceleration", &D::deceleration, quantity(Dimension::acceleration, 0), "deceleration"), "the limit"),
                with_default(field("jerk", &D::jerk, quantity(Dimension::jerk, 0), "jerk"), "the limit"),
            },
            {},
            {}};
}

Table<runtime::PrintedMarks> printed_marks_table() {
    using M = runtime::PrintedMarks;
    Table<M> table{"marks",
                   "Marks along the axis, such as print on a web, seen by a sensor that is wired to probe 1 of the simulated drive.",
                   {
                       required(field("every", &M::every, quantity(Dimension::position, 0), "from one mark to the next")),
                       required(field("length", &M::length, quantity(Dimension::position, 0), "of a mark")),
                       field("first", &M::first, quantity(Dimension::position), "where a mark begins"),
                   },
                   {},
                   {}};
    table.after = [](Reader& reader, const Node& node, M& m) {
        if (m.length > 0 && m.length < m.every) return;
        reader.problem(node.at, "config.out_of_range",
                       fmt::format("`{}`: a mark must be longer than 0 and shorter than `every`", reader.path()),
                       "give `length` the length of one mark, such as 3 mm, and `every` the distance from one beginning to the next");
    };
    return table;
}

Table<axes::sim::ElasticLoad> elastic_load_table() {
    using E = axes::sim::ElasticLoad;
    return {
        "elastic_load",
        "A part of the inertia that hangs behind a belt or a coupling which twists: a resonance to measure.",
        {
            required(field("inertia", &E::load_inertia, quantity(Dimension::inertia, 0), "of that part, at the motor shaft")),
            required(field("frequency", &E::frequency, quantity(Dimension::frequency, 0), "at which it swings while the motor is held")),
            field("damping", &E::damping, quantity(Dimension::friction, 0), "between motor and load"),
        },
        {},
        {}};
}

Table<axes::sim::Cogging> cogging_table() {
    using C = axes::sim::Cogging;
    return {
        "cogging",
        "A torque that comes and goes with the angle of the motor.",
        {
            required(field("amplitude", &C::amplitude, quantity(Dimension::torque, 0), "half of what lies between its highest and lowest")),
            required(field("periods", &C::periods, number(1, 1000), "in a turn of the motor")),
        },
        {},
        {}};
}

Table<axes::sim::ServoGains> servo_gains_table() {
    using G = axes::sim::ServoGains;
    return {"gains",
            "How the loops of the simulated drive are tuned.",
            {
                field("position", &G::position, number(0, 1000), "position gain, 1/s"),
                field("velocity", &G::velocity, number(1, 4000), "velocity gain, 1/s"),
                field("integral", &G::integral, number(0, 1'000'000), "integral gain of the velocity loop, 1/s2"),
                field("feed_forward", &G::feed_forward, number(0, 2), "part of the target's velocity that is fed forward"),
            },
            {},
            {}};
}

Table<AxisSimulation> axis_simulation_table() {
    using S = AxisSimulation;
    return {
        "simulation",
        "The mechanics of the simulated axis. Positions are machine coordinates: 0 is where the homed axis will say 0.",
        {
            field("inertia", &S::inertia, quantity(Dimension::inertia, 0), "motor and load, at the motor shaft"),
            field("viscous_friction", &S::viscous_friction, quantity(Dimension::friction, 0), "friction that grows with speed"),
            field("coulomb_friction", &S::coulomb_friction, quantity(Dimension::torque, 0), "friction that does not"),
            field("load_torque", &S::load_torque, quantity(Dimension::torque),
                  "constant load, such as weight; positive pushes to negative"),
            field("rated_torque", &S::rated_torque, quantity(Dimension::torque, 0), "of the motor"),
            with_default(field("breakaway_torque", &S::breakaway_torque, quantity(Dimension::torque, 0), "friction at standstill"),
                         "as coulomb_friction"),
            field("elastic_load", &S::elastic, section(elastic_load_table()),
                  "a part of the inertia behind a shaft that twists; without it: none"),
            field("cogging", &S::cogging, section(cogging_table()), "torque over the angle of the motor; without it: none"),
            field("gains", &S::gains, section(servo_gains_table()), "of the simulated drive's loops"),
            field("start", &S::start, quantity(Dimension::position), "where the axis stands at power-on"),
            field("racked", &S::racked, quantity(Dimension::position), "how far the follower of a gantry is ahead of its leader then"),
            field_via<S>(
                "stops", interval(Dimension::position),
                [](S& s, const Interval& v) { s.negative_stop = v.first, s.positive_stop = v.second; }, "hard stops", "none"),
            field_via<S>(
                "limit_switches", interval(Dimension::position),
                [](S& s, const Interval& v) { s.negative_limit = v.first, s.positive_limit = v.second; },
                "active below the first, above the second", "none"),
            field_via<S>(
                "home_switch", interval(Dimension::position), [](S& s, const Interval& v) { s.home_from = v.first, s.home_to = v.second; },
                "active in between", "none"),
            field("index_pulse", &S::index_pulse, quantity(Dimension::position),
                  "where one of the encoder's index pulses stands; there is one each motor turn"),
            field("battery", &S::battery,
                  choice<axes::sim::Battery>(
                      {{"good", axes::sim::Battery::good}, {"low", axes::sim::Battery::low}, {"empty", axes::sim::Battery::empty}}),
                  "of an absolute encoder; with an empty one the drive has lost its turns at power-on"),
            field("marks", &S::marks, section(printed_marks_table()), "marks along the axis, seen by a sensor at probe 1 of the drive"),
            with_default(field("turned_by", &S::turned_by, name(), "of an encoder at a terminal: the axis whose motor turns it, u for u"),
                         "nobody: it turns by itself"),
            field("velocity", &S::velocity, quantity(Dimension::velocity), "of an encoder at a terminal that turns by itself"),
            field("analog", &S::analog, section(analog_simulation_table()), "of an `analog` axis: its amplifier"),
            field("clock_drift", &S::clock_drift_ppm, quantity(Dimension::ratio_ppm), "how wrong the drive's clock runs"),
        },
        {},
        {}};
}

Table<axes::PositionIntegral> integral_table() {
    using I = axes::PositionIntegral;
    return {"integral",
            "The I part of the position loop that is closed here. It runs out in Stopping and ErrorStop, and is gone without power.",
            {
                required(field("time", &I::time, duration(I::least_time, std::chrono::hours{1}),
                               "in which it adds to a standing error what the P part makes of it; begin with ten times 1 / kv")),
                with_default(field("limit", &I::limit, quantity(Dimension::velocity, 0), "the most that it adds"), "a tenth of the limit"),
                field("dead_band", &I::dead_band, quantity(Dimension::position, 0),
                      "a smaller following error changes nothing of it; against hunting with friction, some counts of the encoder"),
            },
            {},
            {}};
}

Table<axes::LoadTorque> load_table() {
    using L = axes::LoadTorque;
    return {
        "load",
        "What the load takes of the motor beside its inertia, given to the drive as torque offset (60B2h, which must be mapped). In rated "
        "torques: 0.05 is 5 % of what the motor's plate says; the torque at a steady velocity in each sense shows both friction and "
        "gravity.",
        {
            field("gravity", &L::gravity, number(-L::most, L::most), "that holds the load: positive where its weight pulls to negative"),
            field("coulomb_friction", &L::coulomb_friction, number(0, L::most), "against any motion, smooth through standstill"),
            field("viscous_friction", &L::viscous_friction, number(0), "for each u/s of set velocity"),
            with_default(field("friction_velocity", &L::friction_velocity, quantity(Dimension::velocity, 0),
                               "at this velocity 70 % of the Coulomb friction count, at standstill none"),
                         "a hundredth of the limit"),
        },
        {},
        {}};
}

Table<axes::ControlConfig> control_table() {
    using C = axes::ControlConfig;
    using Mode = axes::ControlMode;
    return {
        "control",
        "How set-points become the drive's targets.",
        {
            field("mode", &C::mode, choice<Mode>({{"position", Mode::position}, {"velocity", Mode::velocity}}),
                  "where the position loop is closed. position: in the drive (CSP) · velocity: here, the drive runs in CSV"),
            with_default(field("kv", &C::kv, number(0), "mode velocity: position gain in 1/s (u/s for each u of following error)"), ""),
            field("feed_forward", &C::feed_forward, number(0, 2),
                  "part of the set velocity given to the drive: as its target in mode velocity, as 60B1h (where mapped) in mode position"),
            field("torque_feed_forward", &C::torque_feed_forward, number(0, 2),
                  "part of the torque that the set acceleration needs, as 60B2h (where mapped)"),
            with_default(
                field("rated_acceleration", &C::rated_acceleration, quantity(Dimension::acceleration, 0),
                      "what rated torque gives the axis, friction apart: for torque feed-forward and the limits of torque control"),
                "unknown"),
            with_default(field("output_limit", &C::output_limit, quantity(Dimension::velocity, 0),
                               "mode velocity: highest velocity given to the drive"),
                         "1.2 times the limit"),
            field("integral", &C::integral, section(integral_table()),
                  "mode velocity: an I part of the position loop; without it there is none"),
            field("load", &C::load, section(load_table()), "torque feed-forward of weight and friction"),
        },
        {},
        {}};
}

Table<axes::PitchPoint> pitch_table() {
    using P = axes::PitchPoint;
    return {"pitch",
            "One point of the table of pitch errors.",
            {
                required(field("at", &P::position, quantity(Dimension::position), "position of the load, as homed")),
                required(field("add", &P::correction, quantity(Dimension::position), "what the motor needs more to get it there")),
            },
            {},
            {}};
}

Table<axes::CompensationConfig> compensation_table() {
    using C = axes::CompensationConfig;
    return {"compensation",
            "What the mechanics lack between motor and load. Programs do not see it.",
            {
                field("backlash", &C::backlash, quantity(Dimension::position, 0),
                      "the motor's way from one flank to the other, added at a reversal"),
                field("velocity", &C::velocity, quantity(Dimension::velocity, 0), "how fast a correction comes in"),
                with_default(field("pitch", &C::pitch, list(section(pitch_table())),
                                   "errors of the pitch by position, linear in between, constant beyond; active once homed"),
                             ""),
            },
            {},
            {}};
}

/// A key for each alarm whose reaction may be chosen; how far, `check` of the axis says with the reason.
Table<axes::ErrorReactions> reactions_table() {
    using R = axes::ErrorReactions;
    Table<R> table{
        "reactions",
        "What the axis does about its own alarms, by their names in docs/reference/alarms.md. Something harder than usual is always "
        "permitted, something milder only where that page says so.",
        {},
        {},
        {}};
    std::vector<std::pair<std::string, axes::ErrorReaction>> words;
    for (const auto& word : axes::reaction_words) words.emplace_back(word.name, word.reaction);
    for (const auto& info : axes::axis_alarms) {
        const auto alarm = static_cast<axes::AxisAlarm>(info.id);
        if (axes::bound_of(alarm) == nullptr) continue;
        table.fields.push_back(field_via<R>(
            std::string(info.name), choice<axes::ErrorReaction>(words),
            [alarm](R& r, const axes::ErrorReaction& chosen) { r.choose(alarm, chosen); }, "reaction to this alarm",
            std::string(axes::word_of(axes::reaction_by_table(alarm)).name)));
    }
    return table;
}

/// What counts, of an axis that only measures. The rest of it is its slave's (Assembly::add_encoder).
void add_counter_fields(std::vector<Field<AxisBinding>>& f) {
    const auto encoder = [](AxisBinding& b) -> axes::EncoderChannel& { return b.encoder ? *b.encoder : b.encoder.emplace(); };
    f.push_back(field_via<AxisBinding>(
        "channel", name(), [encoder](AxisBinding& b, const std::string& channel) { encoder(b).name = channel; },
        "of an axis that only measures: the input of a terminal that counts, where its file lists no `encoders`",
        "the encoder of the terminal's file"));
    f.push_back(field_via<AxisBinding>(
        "object", object_address(),
        [encoder](AxisBinding& b, const ObjectAddress& at) {
            encoder(b).position = {at.index, at.sub};
        },
        "or the object that counts, of any slave: 60E4h:01 of a drive that moves another axis"));
    f.push_back(field_via<AxisBinding>(
        "counter_bits", integer<std::uint8_t>(8, 64), [encoder](AxisBinding& b, const std::uint8_t& bits) { encoder(b).bits = bits; },
        "it counts in so many bits and begins anew, such as the 26 of a single-turn encoder", "all of its object"));
}

/// The axis' own unit, which all its quantities are read in.
Codec<std::string> axis_unit() {
    Codec<std::string> c;
    c.shape.kind = Shape::Kind::choice;
    c.shape.choices = axis_units();
    c.read = [](Reader& reader, const Node& node, std::string& out) {
        const auto index = read_choice(reader, node, axis_units());
        if (!index) return false;
        out = reader.axis_unit = axis_units()[*index];
        return true;
    };
    c.show = [](const std::string& v) { return v; };
    return c;
}

}  // namespace

Table<AxisBinding> axis_table() {
    using A = AxisConfig;
    const auto axis = [](AxisBinding& b) -> A& { return b.axis; };
    Table<AxisBinding> table{
        "axes.<name>", "One axis, by the name that programs use. All its quantities are in its own unit u.", {}, {}, {}};
    auto& f = table.fields;
    f.push_back(required(field_at<AxisBinding>(
        "unit", [](AxisBinding& b) -> std::string& { return b.axis.unit; }, axis_unit(), "the unit u of the axis")));
    f.push_back(with_default(field("slave", &AxisBinding::slave, name(), "slave that drives it; without one the axis is virtual"), ""));
    f.push_back(with_default(field("drive", &AxisBinding::drive, name(), "drive on a serial line that moves it, instead of a slave"), ""));
    f.push_back(field_via<AxisBinding>(
        "axis", integer<std::uint8_t>(1, 64),
        [](AxisBinding& b, const std::uint8_t& n) { b.drive_axis = static_cast<std::uint8_t>(n - 1); },
        "which axis of a drive, or encoder of a terminal, that has several; from 1 as its manual counts", "1 where there is one"));
    add_counter_fields(f);
    std::vector<Field<A>> own{
        required(field("gearing", &A::gearing, section(gearing_table()), "counts and unit")),
        with_default(
            field("modulo", &A::modulo, quantity(Dimension::position, 0),
                  "positions repeat after it (a rotary axis: 360 deg); whole or a simple part of gearing.feed; without software limits"),
            "none: a linear axis"),
        required(field("limits", &A::limits, section(limits_table()), "velocity, acceleration, jerk, travel")),
        field("defaults", &A::defaults, section(defaults_table()), "dynamics where a block says 0"),
        field_at<A>(
            "following_error", [](A& a) -> A& { return a; }, section(following_table()),
            "supervision; without it the following error is not watched"),
        field("in_position", &A::windows, section(in_position_table()), "when a motion is finished"),
        field("homing", &A::homing, section(homing_table()), "how the axis finds its reference"),
        field("position_memory", &A::memory, section(memory_table()), "what its encoder knows after power was off"),
        field("manual", &A::manual, section(manual_table()), "jogging speeds"),
        field("control", &A::control, section(control_table()), "position loop and feed-forward"),
        field("compensation", &A::compensation, section(compensation_table()), "backlash and pitch errors"),
        field("reactions", &A::reactions, section(reactions_table()), "to its own alarms, where others than usual are wanted"),
        field("require_homed", &A::require_homed, boolean(), "absolute moves need a homed axis"),
        field("disabled", &A::disabled, boolean(), "left out while commissioning: its drive is never enabled"),
        field("encoder", &A::encoder, boolean(),
              "it only measures (`limits.velocity`: its fastest): never powered, takes no motion, may be the master of others; "
              "`slave`: a drive or a terminal"),
        field("simulated", &A::simulated, boolean(), "its drive is simulated although the bus is real"),
        field("queue_depth", &A::queue_depth, integer<std::uint8_t>(1, 8), "buffered motions"),
        field_at<A>(
            "stale_limit", [](A& a) -> std::uint16_t& { return a.patience.feedback; }, integer<std::uint16_t>(1, 1000),
            "cycles (on a serial line: rounds of questions) without fresh feedback until the axis stops in error"),
        field_at<A>(
            "feed_patience", [](A& a) -> std::uint16_t& { return a.patience.feed; }, integer<std::uint16_t>(0, 1000),
            "set-points from outside that may miss in a row while the axis moves; then it brakes"),
        field_at<A>(
            "jog_lease", [](A& a) -> Duration& { return a.patience.jog_lease; },
            duration(std::chrono::milliseconds{100}, std::chrono::seconds{5}),
            "a jogging client must repeat its command within this time (ours repeat each 50 ms)"),
        field_at<A>(
            "enable_timeout", [](A& a) -> Duration& { return a.patience.enable; },
            duration(std::chrono::milliseconds{1}, std::chrono::seconds{60}), "a drive that takes longer to enable is an alarm"),
    };
    include_fields(f, axis, Table<A>{{}, {}, std::move(own), {}, {}});
    f.push_back(field_at<AxisBinding>(
        "load_encoder", [](AxisBinding& b) -> AxisBinding& { return b; }, section(load_encoder_table()), "a second encoder, at the load"));
    f.push_back(field_at<AxisBinding>(
        "gantry", [](AxisBinding& b) -> AxisBinding& { return b; }, section(gantry_table()),
        "a second drive for the other side of a portal"));
    f.push_back(field_at<AxisBinding>(
        "brake", [](AxisBinding& b) -> AxisBinding& { return b; }, section(brake_table()), "holding brake, where the controller works it"));
    // Also when something in it is wrong: without it the rest would be judged as the axis of a drive.
    f.push_back(field_at<AxisBinding>(
        "analog", [](AxisBinding& b) -> runtime::AnalogAxis& { return b.analog ? *b.analog : b.analog.emplace(); }, section(analog_table()),
        "an amplifier over +-10 V, with its encoder at `slave`"));
    f.push_back(field("simulation", &AxisBinding::simulation, section(axis_simulation_table()), "mechanics of the simulated axis"));
    table.before = [](Reader& reader, const Node&, AxisBinding& b) { reader.axis_unit = b.axis.unit; };
    table.after = [](Reader& reader, const Node&, AxisBinding& b) {
        reader.units_of_axes[b.axis.name] = b.axis.unit;
        if (b.axis.gantry.on) axes::choose_for_gantry(b.axis.reactions);
    };
    return table;
}

}  // namespace taktwerk::config
