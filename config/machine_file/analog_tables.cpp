#include "config/machine_file/analog_tables.hpp"

#include <fmt/format.h>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

using runtime::AnalogAxis;
using runtime::AnalogSimulation;

Table<AnalogAxis> analog_table() {
    using A = AnalogAxis;
    using D = axes::AnalogDrive;
    Table<A> table{
        "analog",
        "An amplifier over +-10 V: it is told its velocity by an analog output, its encoder is the one at `slave`, and the position "
        "loop is closed here (`control: {mode: velocity, kv: ...}`). Wires are points of `io`.",
        {},
        {},
        {}};
    auto& f = table.fields;
    f.push_back(required(field("setpoint", &A::setpoint, name(), "output in V that tells the velocity")));
    f.push_back(required(field("enable", &A::enable, name(), "output that enables the amplifier")));
    f.push_back(with_default(field("ready", &A::ready, name(), "input: TRUE while it can be, or stay, enabled"), "not wired"));
    f.push_back(with_default(field("fault", &A::fault, name(), "input: TRUE while it has a fault"), "not wired"));
    f.push_back(with_default(field("reset", &A::reset, name(), "output: TRUE while its fault is to be reset"), "not wired"));
    f.push_back(with_default(field("negative_limit", &A::negative_limit, name(), "input: TRUE at the negative end"), "not wired"));
    f.push_back(with_default(field("positive_limit", &A::positive_limit, name(), "input: TRUE at the positive end"), "not wired"));
    f.push_back(with_default(field("home_switch", &A::home_switch, name(), "input: TRUE on the home switch"), "not wired"));
    std::vector<Field<D>> drive{
        required(field("velocity_at_10V", &D::velocity_at_10v, quantity(Dimension::velocity),
                       "velocity of the axis at +10 V; negative where a positive voltage moves it in its negative sense")),
        field("offset", &D::offset, quantity(Dimension::voltage), "added while it is enabled, against its drift; from -1 V to 1 V"),
        field("voltage_limit", &D::voltage_limit, quantity(Dimension::voltage, 0.1), "the most that it is given, either way; at most 10 V"),
        with_default(field("polarity_distance", &D::polarity_distance, quantity(Dimension::position, 0),
                           "run so far against its set-point after it was enabled, it is stopped (drive_polarity)"),
                     "the way of 10 ms at limits.velocity"),
        field("enable_delay", &D::enable_delay, duration(Duration::zero(), std::chrono::seconds{5}),
              "from its enable until it follows its set-point"),
        field("stop_time", &D::stop_time, duration(Duration::zero(), std::chrono::seconds{5}),
              "it is enabled with 0 V for so long, to brake, when its encoder cannot be believed any more"),
    };
    include_fields(
        f, [](A& a) -> D& { return a.drive; }, Table<D>{{}, {}, std::move(drive), {}, {}});
    // In the plain data 0 stands for the default: written, it is meant to switch the watch off, or to make it as strict as can be.
    table.after = [](Reader& reader, const Node& node, A& a) {
        if (const auto* found = node.find("polarity_distance");
            found != nullptr && a.drive.polarity_distance == 0 && !reader.already_bad(reader.path() + ".polarity_distance"))
            reader.problem(found->at, "config.out_of_range", fmt::format("`0` for `{}.polarity_distance` is out of range", reader.path()),
                           "give some hundred counts of the encoder or more, or leave it out for the way of 10 ms at limits.velocity");
    };
    return table;
}

Table<AnalogSimulation> analog_simulation_table() {
    using S = AnalogSimulation;
    return {"analog",
            "The amplifier that is played, of an `analog` axis. Its wires are played, too.",
            {
                field("time_constant", &S::time_constant, duration(Duration::zero(), std::chrono::seconds{10}), "of its velocity loop"),
                field("drift", &S::drift, quantity(Dimension::voltage), "it turns as if so much more were given"),
                field("reversed", &S::reversed, boolean(), "the encoder is wired the other way round: a rehearsal of drive_polarity"),
            },
            {},
            {}};
}

}  // namespace taktwerk::config
