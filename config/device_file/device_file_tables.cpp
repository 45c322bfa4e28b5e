#include "config/device_file/device_file_tables.hpp"

#include <fmt/format.h>

#include "config/drive_file/drive_tables.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

Table<DevicePdo> device_pdo_table() {
    using P = DevicePdo;
    Table<P> table{"pdo", "One PDO of the device.", {}, {}, {}};
    include_fields(
        table.fields, [](P& p) -> ecat::PdoDescription& { return p.pdo; }, pdo_table());
    table.fields.push_back(field("assigned", &P::assigned, boolean(), "it is exchanged as the device comes from the factory"));
    return table;
}

Table<DeviceFile> device_pdo_section() {
    using F = DeviceFile;
    return {"pdo",
            "Process data as the device offers it; of a device without a mailbox as its EEPROM says.",
            {
                with_default(field("rx", &F::rx, list(section(device_pdo_table())), "to the device"), "none"),
                with_default(field("tx", &F::tx, list(section(device_pdo_table())), "from the device"), "none"),
            },
            {},
            {}};
}

Table<ChannelRow> channel_table() {
    using C = ChannelRow;
    Table<C> table{
        "channels.<name>",
        "A value of the process data under a name. `counts` and `value` say what its number means.",
        {
            field("input", &C::input, maybe(object_address()), "the object that the device sends"),
            field("output", &C::output, maybe(object_address()), "or the one that it is sent"),
            with_default(field("type", &C::type, maybe(data_type()), "of the object, where `objects` does not list it"),
                         "BOOL or unsigned, by its bits"),
            field("counts", &C::counts, maybe(measure_pair()), "two numbers of the object, such as [0, 32767]"),
            field("value", &C::value, maybe(measure_pair()), "what these are, such as [0 V, 10 V]"),
            with_default(field("range", &C::range, maybe(measure_pair()),
                               "of an output: between which values the device gives it, such as [0 V, 10 V] where it has no negative ones"),
                         "what the bits of its object hold"),
            field("error", &C::error, maybe(object_address()), "not 0 while the device cannot measure it: wire break, short circuit"),
            field("underrange", &C::underrange, maybe(object_address()), "not 0 while the signal is below what it measures"),
            field("overrange", &C::overrange, maybe(object_address()), "not 0 while the signal is above what it measures"),
            field("doc", &C::doc, text(), "for people"),
        },
        {},
        {}};
    table.after = [](Reader& reader, const Node& node, C& c) {
        if (reader.already_bad(reader.path())) return;
        if (c.input.has_value() == c.output.has_value())
            reader.problem(node.at, "config.channel", fmt::format("`{}` needs either `input` or `output`", reader.path()),
                           "give the object in the process data, such as `input: 6000h:11`");
        if (c.counts.has_value() != c.value.has_value())
            reader.problem(node.at, "config.channel", "`counts` and `value` belong together",
                           "write both: `counts: [0, 32767], value: [0 V, 10 V]`");
        if (c.counts && !c.counts->unit.empty())
            reader.problem(node.at, "config.channel", "`counts` are numbers of the object, without a unit",
                           "write for instance `counts: [0, 32767]`");
        if (c.value && c.value->unit.empty())
            reader.problem(node.at, "config.unit_missing", "`value` has no unit", "write it with one, such as `value: [0 V, 10 V]`");
        if (c.range && (!c.output || !c.value || c.range->unit != c.value->unit))
            reader.problem(node.at, "config.channel", "`range` is of an output with a `value`, and in its unit",
                           "write for instance `value: [0 V, 10 V], range: [0 V, 10 V]`");
        if (c.range && !(c.range->first < c.range->second))
            reader.problem(node.at, "config.channel", "the lower end of `range` is not below the upper one", "write `range: [low, high]`");
        if (c.output && (c.error || c.underrange || c.overrange))
            reader.problem(node.at, "config.channel", "an output has no `error`, `underrange` or `overrange`",
                           "make them channels of their own");
    };
    return table;
}

Table<EncoderLatchRow> encoder_latch_table(const char* which, const char* doc) {
    using L = EncoderLatchRow;
    return {which,
            doc,
            {
                required(field("arm", &L::arm, name(), "output: 1 lets it wait")),
                required(field("latched", &L::latched, name(), "input: 1 from the event on, until `arm` is taken back")),
            },
            {},
            {}};
}

Table<EncoderRow> encoder_table() {
    using E = EncoderRow;
    return {
        "encoders",
        "A position that may be an axis (`encoder: true`), by names of channels. While the `error` of its channel shows, it does not hold.",
        {
            required(field("position", &E::position, name(), "input that counts")),
            field("incremental", &E::incremental, boolean(), "true: it begins to count at 0 when the device gets its supply"),
            with_default(field("valid", &E::valid, name(), "input that is 0 while the position does not hold"), "none"),
            with_default(field("latch", &E::latch, name(), "input with the position at the event: touch probe 1 of the axis"), "none"),
            field("index", &E::index, maybe(section(encoder_latch_table("index", "Latches at the encoder's index."))),
                  "latches at the encoder's index"),
            field("rising", &E::rising, maybe(section(encoder_latch_table("rising", "Latches at the rising edge of its input."))),
                  "latches at the rising edge of its input"),
            field("falling", &E::falling, maybe(section(encoder_latch_table("falling", "Latches at the falling edge of its input."))),
                  "latches at the falling edge of its input"),
        },
        {},
        {}};
}

}  // namespace

Table<DeviceFile> device_file_table() {
    using F = DeviceFile;
    Table<F> table{
        "device file", "What one device type is that is no drive: a coupler, a terminal, an encoder, a valve island.", {}, {}, {}};
    auto& f = table.fields;
    f.push_back(version_field(&F::version));
    f.push_back(required(field("name", &F::name, name(), "as machines name it: `device: el3102`")));
    f.push_back(required(field("vendor", &F::vendor, text(), "for people")));
    f.push_back(required(field("title", &F::title, text(), "for people")));
    f.push_back(required(field("source", &F::source, text(), "where these facts come from")));
    f.push_back(required(field("checked", &F::checked, checked_against(), checked_doc)));
    include_fields(
        f, [](F& d) -> ecat::DeviceDescription& { return d.device; }, Table<ecat::DeviceDescription>{{}, {}, controller_fields(), {}, {}});
    f.push_back(with_default(field_at<F>(
                                 "ebus", [](F & d) -> auto& { return d.device.ebus_current; }, maybe(milliampere()),
                                 "what it takes from the E-bus, `130 mA`; negative: what it supplies, `-2000 mA`"),
                             "not known"));
    f.push_back(field_at<F>(
        "pdo", [](F& d) -> F& { return d; }, section(device_pdo_section()), "process data as the device offers it"));
    f.push_back(field("objects", &F::objects, list(section(object_table())), "of the dictionary; those of PDOs need not be listed"));
    f.push_back(
        field("startup", &F::startup, list(section(startup_table())), "SDOs written on every bring-up, before those of the machine"));
    f.push_back(with_default(
        field("channels", &F::channels, by_name(section(channel_table()), [](ChannelRow& c) -> std::string& { return c.name; }),
              "its values by name; a machine names them in `io`"),
        "none"));
    f.push_back(field("encoders", &F::encoders, list(section(encoder_table())),
                      "counters and encoders that may be axes; an axis says which by `axis`, from 1"));
    for (auto& one : f)
        if (one.info.key == "objects" || one.info.key == "startup" || one.info.key == "encoders") one.info.default_text.clear();
    return table;
}

}  // namespace taktwerk::config
