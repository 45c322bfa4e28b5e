#include "config/machine_file/axis_mechanics_tables.hpp"

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

using runtime::AxisBinding;

namespace {

Table<axes::GantryConfig> skew_table() {
    using G = axes::GantryConfig;
    return {"max_skew",
            "How far the sides may be apart, from where they were when they got their power.",
            {
                with_default(field("warning", &G::warning, quantity(Dimension::position, 0), "from here on it is shown"), "never"),
                required(field("error", &G::error, quantity(Dimension::position, 0),
                               "beyond it the axis stops: what the portal bears unharmed")),
            },
            {},
            {}};
}

Table<axes::GantryConfig> square_table() {
    using G = axes::GantryConfig;
    return {
        "square",
        "MC_Home squares the portal: each side has a home switch on its own drive, and the follower is led until both are at their edges.",
        {
            required(field("velocity", &G::square_velocity, quantity(Dimension::velocity, 0), "at which the follower is led alone")),
            field("offset", &G::square_offset, quantity(Dimension::position),
                  "how much further the follower's switch lies than the leader's where the portal is square"),
        },
        {},
        {}};
}

}  // namespace

Table<AxisBinding> load_encoder_table() {
    using L = axes::LoadEncoderConfig;
    Table<AxisBinding> table{
        "load_encoder",
        "A second encoder at the load, read from an input of the machine: an object of the drive (60E4h), the position of another "
        "slave, or a value of a terminal. It is compared with the motor; the position loop stays the drive's.",
        {},
        {},
        {}};
    auto& f = table.fields;
    f.push_back(required(field("input", &AxisBinding::load_input, name(), "one of `io.inputs`: its counts")));
    std::vector<Field<L>> own{
        required(field("counts_per_unit", &L::counts_per_unit, number(0), "counts per u of the load")),
        field("inverted", &L::inverted, boolean(), "true: it counts against the axis' sense"),
        field("bits", &L::bits, integer<std::uint8_t>(8, 64), "of its counter, which begins anew beyond them"),
        required(field("tolerance", &L::tolerance, quantity(Dimension::position, 0),
                       "how far motor and load may be apart: coupling, backlash, and the way of some cycles at full speed")),
        field("time", &L::time, duration(), "beyond it for this long: alarm load_deviation"),
        field("position", &L::shown, choice<bool>({{"monitor", false}, {"actual", true}}),
              "monitor: only compared · actual: the axis' actual position is the load's"),
    };
    include_fields(
        f, [](AxisBinding& b) -> L& { return b.axis.load_encoder; }, Table<L>{{}, {}, std::move(own), {}, {}});
    table.before = [](Reader&, const Node&, AxisBinding& b) { b.axis.load_encoder.on = true; };
    return table;
}

Table<AxisBinding> gantry_table() {
    Table<AxisBinding> table{
        "gantry",
        "Two drives that move one portal, as one axis: `slave` is the leader, and the axis' position is its. Both get the same "
        "set-point, are powered together and stop together.",
        {},
        {},
        {}};
    auto& f = table.fields;
    f.push_back(required(field_at<AxisBinding>(
        "follower", [](AxisBinding& b) -> std::string& { return b.follower.slave; }, name(),
        "slave of the other side: the same type of drive")));
    f.push_back(field_via<AxisBinding>(
        "axis", integer<std::uint8_t>(1, 64),
        [](AxisBinding& b, const std::uint8_t& n) { b.follower.drive_axis = static_cast<std::uint8_t>(n - 1); },
        "which axis of a drive that has several", "1"));
    f.push_back(field_at<AxisBinding>(
        "mirrored", [](AxisBinding& b) -> bool& { return b.follower.mirrored; }, boolean(), "its motor turns the other way round"));
    f.push_back(required(field_at<AxisBinding>(
        "max_skew", [](AxisBinding& b) -> axes::GantryConfig& { return b.axis.gantry; }, section(skew_table()),
        "how far they may be apart")));
    f.push_back(field_at<AxisBinding>(
        "square", [](AxisBinding& b) -> axes::GantryConfig& { return b.axis.gantry; }, section(square_table()),
        "homing squares the portal by the home switches of both sides"));
    table.before = [](Reader&, const Node&, AxisBinding& b) { b.axis.gantry.on = true; };
    return table;
}

/// Keys of the axis, and the name of an output, which is the machine's.
Table<AxisBinding> brake_table() {
    using B = axes::BrakeBy;
    Table<AxisBinding> table{
        "brake",
        "The holding brake, where the controller works it: it opens with the power, and power waits until it has closed again. A drive "
        "that works its own brake needs none of this.",
        {},
        {},
        {}};
    auto& f = table.fields;
    f.push_back(required(field_at<AxisBinding>(
        "by", [](AxisBinding& b) -> B& { return b.axis.brake.by; },
        choice<B>({{"drive", B::drive}, {"object", B::object}, {"output", B::output}}),
        "drive: the drive, by itself · object: the controller, through 60FEh of the drive · output: the controller, through an output of "
        "the "
        "machine")));
    f.push_back(
        with_default(field("output", &AxisBinding::brake_output, name(), "by output: the one that opens it; closed without current"), ""));
    f.push_back(field_at<AxisBinding>(
        "release", [](AxisBinding& b) -> Duration& { return b.axis.brake.release; }, duration(),
        "from the word to open it until it is open: motion waits for it; at most 5 s"));
    f.push_back(field_at<AxisBinding>(
        "engage", [](AxisBinding& b) -> Duration& { return b.axis.brake.engage; }, duration(),
        "from the word to close it until it holds: power waits for it; at most 5 s"));
    f.push_back(field_at<AxisBinding>(
        "release_without_power", [](AxisBinding& b) -> bool& { return b.axis.brake.release_without_power; },
        choice<bool>({{"forbidden", false}, {"permitted", true}}),
        "MC_SetBrake may open it while the axis has no power: only where no load can sink"));
    return table;
}

}  // namespace taktwerk::config
