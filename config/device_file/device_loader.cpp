#include "config/device_file/device_loader.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/device_file/device_file_tables.hpp"
#include "config/reading/quantity.hpp"
#include "ecat/sim/digital_terminal.hpp"

namespace taktwerk::config {

namespace {

using ecat::DataType;
using runtime::IoDirection;
using runtime::PointStatus;

DataType unsigned_of(unsigned bits) noexcept {
    return bits == 1 ? DataType::BOOL : bits <= 8 ? DataType::U8 : bits <= 16 ? DataType::U16 : bits <= 32 ? DataType::U32 : DataType::U64;
}

/// Completes a file that was read: bits of mapped objects, the dictionary that follows from them, the channels.
class DeviceBuilder {
public:
    DeviceBuilder(Reader& reader, DeviceFile& file) : reader_(reader), file_(file) {}

    LoadedDevice build() {
        auto& device = file_.device;
        device.name = file_.name;
        for (const auto& row : file_.objects)
            if (row.is_object()) device.objects.push_back(row.object);
        add_direction(file_.rx, device.rx_pdos, device.rx_assigned, device.rx_rules, true);
        add_direction(file_.tx, device.tx_pdos, device.tx_assigned, device.tx_rules, false);
        add_objects_of_modules();
        LoadedDevice out;
        for (const auto& row : file_.channels) add_channel(out, row);
        for (std::size_t n = 0; n < file_.encoders.size(); ++n) add_encoder(out, file_.encoders[n], fmt::format("encoders.{}", n));
        out.title = file_.title, out.vendor = file_.vendor, out.source = file_.source, out.checked = file_.checked;
        out.startup = resolve_startup(reader_, reader_.file(), file_.startup, device);
        out.device = std::make_shared<const ecat::DeviceDescription>(std::move(device));
        return out;
    }

private:
    void problem(const std::string& path, std::string what, std::string remedy) {
        reader_.problem(reader_.find(path), "config.device", std::move(what), std::move(remedy));
    }

    [[nodiscard]] std::optional<DataType> type_of(const ecat::PdoEntry& entry) const {
        if (const auto* object = find_object(file_.device, entry.index, entry.sub)) return object->type;
        for (const auto& row : file_.channels)
            for (const auto& address : {row.input, row.output})
                if (address && address->index == entry.index && address->sub == entry.sub && row.type) return row.type;
        return std::nullopt;
    }

    void add_direction(std::vector<DevicePdo>& rows, std::vector<ecat::PdoDescription>& pdos, std::vector<std::uint16_t>& assigned,
                       ecat::PdoRules& rules, bool rx) {
        std::size_t entries = 1;
        for (std::size_t n = 0; n < rows.size(); ++n) {
            auto& pdo = rows[n].pdo;
            for (auto& entry : pdo.entries) complete(entry, rx, fmt::format("pdo.{}.{}", rx ? "rx" : "tx", n));
            entries = std::max(entries, pdo.entries.size());
            if (rows[n].assigned) assigned.push_back(pdo.index);
            pdos.push_back(pdo);
        }
        rules.max_assigned = static_cast<std::uint8_t>(std::clamp<std::size_t>(rows.size(), 1, 32));
        rules.max_entries = static_cast<std::uint8_t>(std::min<std::size_t>(entries, 254));
    }

    void complete(ecat::PdoEntry& entry, bool rx, const std::string& path) {
        if (entry.index == 0) return;
        const auto type = type_of(entry);
        if (entry.bits == 0 && type) entry.bits = ecat::bit_size(*type);
        if (entry.bits == 0) {
            const auto shown = show_object(entry.index, entry.sub);
            problem(path, fmt::format("it is not said how many bits {} has", shown),
                    fmt::format("write `{}/16`, or give its channel a `type`", shown));
            return;
        }
        const auto mappable = rx ? ecat::Mappable::rx : ecat::Mappable::tx;
        auto& objects = file_.device.objects;
        const auto known = std::ranges::find_if(objects, [&](const auto& o) { return o.index == entry.index && o.sub == entry.sub; });
        if (known != objects.end()) {
            if (known->mappable == ecat::Mappable::no) known->mappable = mappable;
            return;
        }
        ecat::ObjectEntry object;
        object.index = entry.index;
        object.sub = entry.sub;
        object.name = name_of(entry);
        object.type = type.value_or(unsigned_of(entry.bits));
        object.access = rx ? ecat::Access::rw : ecat::Access::ro;
        object.mappable = mappable;
        objects.push_back(std::move(object));
    }

    /// What modules carry, in every slot: `objects` of slot 0 say the type. Modules that use the same number share one object, as wide as the
    /// widest of them.
    void add_objects_of_modules() {
        auto& objects = file_.device.objects;
        const auto& slots = file_.device.slots;
        std::map<std::pair<std::uint16_t, std::uint8_t>, std::size_t> places;
        for (std::size_t n = 0; n < objects.size(); ++n) places.emplace(std::pair{objects[n].index, objects[n].sub}, n);
        const auto add = [&](const ecat::ModuleDescription& module, const ecat::PdoEntry& entry, std::uint8_t slot, bool rx) {
            if (entry.index == 0 || entry.bits == 0) return;
            const auto like = places.find({entry.index, entry.sub});
            auto type = like == places.end() ? unsigned_of(entry.bits) : objects[like->second].type;
            if (ecat::bit_size(type) < entry.bits) type = unsigned_of(entry.bits);
            const auto mappable = rx ? ecat::Mappable::rx : ecat::Mappable::tx;
            const auto index = static_cast<std::uint16_t>(entry.index + slot * slots.index_increment);
            const auto [place, is_new] = places.emplace(std::pair{index, entry.sub}, objects.size());
            if (is_new) {
                ecat::ObjectEntry object;
                object.index = index, object.sub = entry.sub;
                object.name = module.name;
                object.type = type;
                object.access = rx ? ecat::Access::rw : ecat::Access::ro;
                object.mappable = mappable;
                objects.push_back(std::move(object));
                return;
            }
            auto& known = objects[place->second];
            if (ecat::bit_size(known.type) < entry.bits) known.type = type;
            if (known.mappable == ecat::Mappable::no) known.mappable = mappable;
            else if (known.mappable != mappable) known.mappable = ecat::Mappable::both;
        };
        for (unsigned slot = 0; slot < slots.count; ++slot)
            for (const auto& module : slots.modules)
                for (const bool rx : {true, false})
                    for (const auto& pdo : rx ? module.rx_pdos : module.tx_pdos)
                        for (const auto& entry : pdo.entries) add(module, entry, static_cast<std::uint8_t>(slot), rx);
    }

    [[nodiscard]] std::string name_of(const ecat::PdoEntry& entry) const {
        const auto is = [&](const std::optional<ObjectAddress>& a) { return a && a->index == entry.index && a->sub == entry.sub; };
        for (const auto& row : file_.channels) {
            if (is(row.input) || is(row.output)) return row.name;
            if (is(row.error)) return row.name + " error";
            if (is(row.underrange)) return row.name + " underrange";
            if (is(row.overrange)) return row.name + " overrange";
        }
        return "process data";
    }

    [[nodiscard]] bool is_mapped(const ObjectAddress& address, bool rx) const {
        const auto has = [&](const std::vector<ecat::PdoDescription>& pdos) {
            return std::ranges::any_of(pdos, [&](const auto& pdo) {
                return std::ranges::any_of(pdo.entries, [&](const auto& e) { return e.index == address.index && e.sub == address.sub; });
            });
        };
        if (has(rx ? file_.device.rx_pdos : file_.device.tx_pdos)) return true;
        return std::ranges::any_of(file_.device.slots.modules,
                                   [&](const auto& module) { return has(rx ? module.rx_pdos : module.tx_pdos); });
    }

    void add_channel(LoadedDevice& out, const ChannelRow& row) {
        const bool rx = row.output.has_value();
        const auto& address = rx ? row.output : row.input;
        if (!address) return;  // said already
        const auto here = "channels." + row.name;
        const auto expect_mapped = [&](const ObjectAddress& a) {
            if (!is_mapped(a, rx))
                problem(here, fmt::format("no PDO {} the device carries {}", rx ? "to" : "from", show_object(a.index, a.sub)),
                        "add it to a PDO, or correct the object");
        };
        expect_mapped(*address);
        DeviceChannel channel;
        channel.name = row.name;
        channel.direction = rx ? IoDirection::output : IoDirection::input;
        channel.index = address->index, channel.sub = address->sub;
        channel.doc = row.doc;
        const auto* object = find_object(file_.device, address->index, address->sub);
        const auto type = object != nullptr ? object->type : row.type.value_or(DataType::U32);
        if (type == DataType::REAL32) channel.line.number = PointLine::Number::real32;
        if (type == DataType::REAL64) channel.line.number = PointLine::Number::real64;
        if (object != nullptr) channel.line.fit(ecat::bit_size(type), ecat::is_signed(type));
        if (row.counts && row.value) {
            channel.line.factor = (row.value->second - row.value->first) / (row.counts->second - row.counts->first);
            channel.line.offset = row.value->first - row.counts->first * channel.line.factor;
            channel.unit = row.value->unit;
            if (row.range) {
                const auto [low, high] = std::minmax({channel.line.number_at(row.range->first), channel.line.number_at(row.range->second)});
                channel.line.least = std::max(channel.line.least, low), channel.line.most = std::min(channel.line.most, high);
            }
        }
        const auto add_status = [&](const std::optional<ObjectAddress>& a, PointStatus::Kind kind) {
            if (!a) return;
            expect_mapped(*a);
            channel.status.push_back({kind, a->index, a->sub});
        };
        add_status(row.error, PointStatus::Kind::error);
        add_status(row.underrange, PointStatus::Kind::underrange);
        add_status(row.overrange, PointStatus::Kind::overrange);
        out.channels.push_back(std::move(channel));
    }

    void add_encoder(LoadedDevice& out, const EncoderRow& row, const std::string& here) {
        const auto channel = [&](const std::string& name, IoDirection direction, const std::string& key) -> const DeviceChannel* {
            if (name.empty()) return nullptr;
            const auto* found = find_channel(out, direction, name);
            const auto names = channel_names(out, direction);
            if (found == nullptr)
                problem(here + "." + key, fmt::format("it has no {} '{}'", direction == IoDirection::input ? "input" : "output", name),
                        fmt::format("name one of its channels: {}", fmt::join(names, ", ")));
            return found;
        };
        const auto object = [&](const std::string& name, IoDirection direction, const std::string& key) -> axes::ParameterAddress {
            const auto* found = channel(name, direction, key);
            return found != nullptr ? axes::ParameterAddress{found->index, found->sub} : axes::ParameterAddress{};
        };
        const auto latch = [&](const std::optional<EncoderLatchRow>& way, const std::string& key) -> axes::EncoderLatch {
            if (!way) return {};
            return {object(way->arm, IoDirection::output, key + ".arm"), object(way->latched, IoDirection::input, key + ".latched")};
        };
        const auto* position = channel(row.position, IoDirection::input, "position");
        if (position == nullptr) return;
        auto encoder = encoder_of(*position);
        encoder.incremental = row.incremental;
        encoder.valid = object(row.valid, IoDirection::input, "valid");
        encoder.latch = object(row.latch, IoDirection::input, "latch");
        encoder.index = latch(row.index, "index");
        encoder.rising = latch(row.rising, "rising");
        encoder.falling = latch(row.falling, "falling");
        if (row.latch.empty() == (row.index || row.rising || row.falling))
            problem(here, "`latch` and what it latches belong together", "give both, or neither");
        if (row.index && !row.rising) problem(here, "an index without the rising edge of an input is not served", "give `rising` as well");
        out.encoders.push_back(std::move(encoder));
    }

    Reader& reader_;
    DeviceFile& file_;
};

}  // namespace

namespace {

std::variant<LoadedDevice, std::vector<Error>> load(const std::string& path, Document document) {
    Reader reader(path);
    reader.errors() = std::move(document.errors);
    DeviceFile file;
    if (document.root.kind != Node::Kind::null) read_table(reader, document.root, device_file_table(), file);
    if (!reader.errors().empty()) return std::move(reader.errors());
    auto device = DeviceBuilder(reader, file).build();
    if (const auto stem = std::filesystem::path(path).stem().string(); stem != file.name)
        reader.problem_in("name", "config.device", fmt::format("the file is called '{}', and the device in it '{}'", stem, file.name),
                          "call both the same: machines name the file");
    if (!reader.errors().empty()) return std::move(reader.errors());
    device.files = {path};
    return device;
}

}  // namespace

std::variant<LoadedDevice, std::vector<Error>> load_device(const std::string& path) { return load(path, read_document(path)); }

std::variant<LoadedDevice, std::vector<Error>> load_device_text(const std::string& path, std::string_view text) {
    return load(path, parse_document(path, text));
}

LoadedDevice digital_terminal(std::uint8_t inputs, std::uint8_t outputs) {
    LoadedDevice out;
    out.device = std::make_shared<const ecat::DeviceDescription>(ecat::sim::digital_input_output_terminal(inputs, outputs));
    const auto add = [&](IoDirection direction, const char* name, std::uint16_t index, std::uint8_t count) {
        for (unsigned n = 1; n <= count; ++n)
            out.channels.push_back({fmt::format("{}{}", name, n), direction, index, static_cast<std::uint8_t>(n)});
    };
    add(IoDirection::input, "in", 0x6000, inputs);
    add(IoDirection::output, "out", 0x7000, outputs);
    return out;
}

const DeviceChannel* find_channel(const LoadedDevice& device, IoDirection direction, const std::string& name) noexcept {
    const auto number = parse_integer(name);
    std::int64_t n = 0;
    for (const auto& channel : device.channels) {
        if (channel.direction != direction) continue;
        ++n;
        if (number ? n == *number : channel.name == name) return &channel;
    }
    return nullptr;
}

axes::EncoderChannel encoder_of(const DeviceChannel& channel) {
    axes::EncoderChannel encoder;
    encoder.name = channel.name;
    encoder.position = {channel.index, channel.sub};
    for (const auto& status : channel.status)
        if (status.kind == PointStatus::Kind::error) encoder.errors.push_back({status.index, status.sub});
    return encoder;
}

std::vector<std::string> channel_names(const LoadedDevice& device, IoDirection direction) {
    std::vector<std::string> out;
    for (const auto& channel : device.channels)
        if (channel.direction == direction) out.push_back(channel.name);
    return out;
}

}  // namespace taktwerk::config
