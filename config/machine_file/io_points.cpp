#include "config/machine_file/io_points.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/nearest_name.hpp"
#include "modbus/tcp/channel_words.hpp"

namespace taktwerk::config {

namespace {

using runtime::IoDirection;

class PointBuilder {
public:
    PointBuilder(Reader& reader, const IoEntry& entry, IoDirection direction, const PointPlace& place)
        : reader_(reader),
          entry_(entry),
          input_(direction == IoDirection::input),
          place_(place),
          here_(fmt::format("io.{}.{}", input_ ? "inputs" : "outputs", entry.point.name)),
          point_(entry.point) {
        point_.direction = direction;
    }

    runtime::IoPoint build(const std::vector<runtime::IoPoint>& others) {
        find();
        if (good_ && (channel_ || point_.beside)) expect_free(others);
        measure_width();
        scale();
        limit();
        if (bits_ != 0) expect_fitting_keys();
        if (entry_.safe) point_.safe_value = word(*entry_.safe, "safe").value_or(0);
        if (entry_.simulated) point_.simulated = word(*entry_.simulated, "simulated");
        return std::move(point_);
    }

private:
    void problem(const char* key, const char* code, std::string what, std::string remedy) {
        const auto path = fmt::format("{}.{}", here_, key);
        reader_.problem(reader_.find(path), code, std::move(what), std::move(remedy));
        reader_.mark_bad(path);
        good_ = false;
    }

    void find() {
        if (place_.modbus) return find_register();
        if (entry_.object) {
            point_.index = entry_.object->index, point_.sub = entry_.object->sub;
            adopt_number();
            return;
        }
        if (entry_.channel.empty() || !place_.known) return;
        if (!place_.device) {
            problem("channel", "config.no_channel", fmt::format("slave '{}' is no terminal: it has no channels", point_.slave),
                    "use `object:`, such as `object: 60FDh`");
            return;
        }
        channel_ = find_channel(*place_.device, point_.direction, entry_.channel);
        if (!channel_) return no_channel();
        point_.index = channel_->index, point_.sub = channel_->sub;
        point_.line = channel_->line;
        point_.unit = channel_->unit;
        point_.status = channel_->status;
    }

    void find_register() {
        const auto& device = *place_.modbus;
        point_.beside = Signal{};
        point_.index = 0xFFFF;  // none, so far
        if (entry_.object)
            return problem("object", "config.no_channel", fmt::format("'{}' is a Modbus device: it has no objects", device.name),
                           "name one of its `registers` as `channel`");
        std::vector<std::string> names;
        for (const auto& one : device.channels) names.push_back(one.name);
        const auto found = std::ranges::find(names, entry_.channel);
        if (found == names.end()) {
            std::string list;
            for (const auto& one : names) list += (list.empty() ? "" : ", ") + one;
            const auto near = nearest_name(entry_.channel, names);
            return problem("channel", "config.no_channel",
                           fmt::format("Modbus device '{}' has no register '{}' (there is: {})", device.name, entry_.channel,
                                       list.empty() ? "none" : list),
                           near.empty() ? fmt::format("add it under `modbus_tcp.{}.registers`", device.name)
                                        : fmt::format("did you mean `{}`?", near));
        }
        const auto place = static_cast<std::size_t>(found - names.begin());
        const auto type = device.channels[place].type;
        point_.index = static_cast<std::uint16_t>(place);
        point_.beside = modbus::tcp::signal_of(type);
        if (type == modbus::tcp::NumberType::float32) point_.line.number = PointLine::Number::real32;
    }

    /// Of an object that no channel names: a real number is one all the same.
    void adopt_number() {
        if (!place_.description) return;
        const auto* object = find_object(*place_.description, point_.index, point_.sub);
        if (object == nullptr) return;
        if (object->type == ecat::DataType::REAL32) point_.line.number = PointLine::Number::real32;
        if (object->type == ecat::DataType::REAL64) point_.line.number = PointLine::Number::real64;
    }

    /// Bits and sign of a slave's object, as far as its description has them.
    void measure_width() {
        if (!good_ || place_.description == nullptr || place_.modbus != nullptr) return;
        const auto* object = find_object(*place_.description, point_.index, point_.sub);
        if (object == nullptr) return;
        bits_ = ecat::bit_size(object->type);
        const auto& pdos = input_ ? place_.description->tx_pdos : place_.description->rx_pdos;
        for (const auto& pdo : pdos)
            for (const auto& entry : pdo.entries)
                if (entry.index == point_.index && entry.sub == point_.sub) bits_ = entry.bits;
        point_.line.fit(bits_, ecat::is_signed(object->type));
    }

    /// What does nothing to a bit, or to a number.
    void expect_fitting_keys() {
        if (bits_ == 1 && point_.filter > Duration::zero())
            problem("filter", "config.conflict", "the point is one bit, which has no value between 0 and 1 to filter",
                    "remove `filter`; a contact that bounces is for the terminal's own filter, or for a TON in the program");
        if (bits_ > 1 && point_.inverted)
            problem("inverted", "config.conflict", fmt::format("the point has {} bits, and only one bit can be inverted", bits_),
                    "remove `inverted`; a number is turned round by a `scale` whose values fall");
    }

    void no_channel() {
        const auto names = channel_names(*place_.device, point_.direction);
        const auto kind = input_ ? "inputs" : "outputs";
        if (place_.is_terminal || parse_integer(entry_.channel)) {
            problem("channel", "config.no_channel",
                    fmt::format("{} '{}' has {} {}, there is no channel {}", place_.is_terminal ? "terminal" : "slave", point_.slave,
                                names.size(), kind, entry_.channel),
                    !names.empty() ? fmt::format("choose 1 to {}", names.size()) : "choose another terminal");
            return;
        }
        std::string list;
        for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
        const auto near = nearest_name(entry_.channel, names);
        problem("channel", "config.no_channel",
                fmt::format("slave '{}' ({}) has no {} channel '{}' (there is: {})", point_.slave, place_.device->device->name,
                            input_ ? "input" : "output", entry_.channel, list.empty() ? "none" : list),
                near.empty() ? "correct the name" : fmt::format("did you mean `{}`?", near));
    }

    void expect_free(const std::vector<runtime::IoPoint>& others) {
        for (const auto& other : others)
            if (other.direction == point_.direction && other.slave == point_.slave && other.index == point_.index &&
                other.sub == point_.sub)
                problem("channel", "config.channel_taken",
                        fmt::format("channel {} of '{}' is already '{}'", entry_.channel, point_.slave, other.name),
                        "give each point its own channel");
    }

    /// The line of the channel, and behind it that of the point.
    void scale() {
        if (!entry_.scale || !good_) return;
        const auto& [from, to] = *entry_.scale;
        const bool raw = from.unit.empty();
        if (!raw && from.unit != point_.unit) {
            problem(
                "scale", "config.scale",
                point_.unit.empty() ? fmt::format("the channel has no unit of its own, and `from` is in {}", from.unit)
                                    : fmt::format("the channel is in {}, and `from` in {}", point_.unit, from.unit),
                point_.unit.empty() ? "give `from` as two raw numbers, without a unit" : fmt::format("write `from` in {}", point_.unit));
            return;
        }
        if (to.unit.empty()) {
            problem("scale", "config.unit_missing", "`to` has no unit", "write it with one, such as `to: [0 bar, 16 bar]`");
            return;
        }
        const double factor = (to.second - to.first) / (from.second - from.first);
        const double offset = to.first - from.first * factor;
        auto before = point_.line;
        if (raw) before.factor = 1, before.offset = 0;
        point_.line = before;
        point_.line.factor = before.factor * factor;
        point_.line.offset = before.offset * factor + offset;
        point_.unit = to.unit;
        if (!std::isfinite(point_.line.factor) || point_.line.factor == 0 || !std::isfinite(point_.line.offset))
            problem("scale", "config.scale", "the scale is no finite line", "give two different values in `from` and in `to`");
    }

    bool in_our_unit(const std::string& unit, const char* key) {
        if (unit == point_.unit) return true;
        if (good_)
            problem(key, "config.unit_wrong",
                    point_.unit.empty() ? fmt::format("`{}` is in {}, and the point has no unit", key, unit)
                    : unit.empty()      ? fmt::format("`{}` has no unit, and the point is in {}", key, point_.unit)
                                        : fmt::format("`{}` is in {}, and the point in {}", key, unit, point_.unit),
                    point_.unit.empty() ? "write it as the raw number, or give the point a `scale`"
                                        : fmt::format("write it in {}", point_.unit));
        return false;
    }

    void limit() {
        if (!entry_.limits || !in_our_unit(entry_.limits->unit, "limits")) return;
        if (!(entry_.limits->first < entry_.limits->second)) {
            problem("limits", "config.out_of_range", "the lower limit is not below the upper one", "write `limits: [low, high]`");
            return;
        }
        if (const auto [low, high] = ends();
            point_.line.number == PointLine::Number::whole && (entry_.limits->first > high || entry_.limits->second < low)) {
            problem("limits", "config.out_of_range", fmt::format("no value of the input lies between them: it shows {}", range_text()),
                    "compare `limits` with `scale`, and with what the terminal measures");
            return;
        }
        point_.limits = runtime::PointLimits{entry_.limits->first, entry_.limits->second};
    }

    /// The least and the highest value of a whole number.
    [[nodiscard]] std::pair<double, double> ends() const {
        const auto at = [&](double number) { return number * point_.line.factor + point_.line.offset; };
        return std::minmax({at(point_.line.least), at(point_.line.most)});
    }
    [[nodiscard]] std::string range_text() const {
        const auto [low, high] = ends();
        return fmt::format("{:.6g}{} to {:.6g}{}", low, point_.unit.empty() ? "" : " " + point_.unit, high,
                           point_.unit.empty() ? "" : " " + point_.unit);
    }

    /// Beyond what the object holds it would come out as another value.
    std::optional<std::int64_t> within(double number, const Measure& written, const char* key) {
        const auto& line = point_.line;
        if (line.number != PointLine::Number::whole || (number >= line.least && number <= line.most))
            return static_cast<std::int64_t>(number);
        const bool plain = written.unit.empty();
        problem(key, "config.out_of_range",
                fmt::format("{:g}{} for `{}` is beyond what the channel {}: {}", written.value, plain ? "" : " " + written.unit, key,
                            input_ ? "shows" : "gives", plain ? fmt::format("{:.0f} to {:.0f}", line.least, line.most) : range_text()),
                "give a value within it, or choose another terminal");
        return std::nullopt;
    }

    /// A value with a unit through the line; a bare number is the raw word, as a terminal carries it.
    std::optional<std::int64_t> word(const Measure& written, const char* key) {
        const bool plain = written.unit.empty();
        if (!plain && !in_our_unit(written.unit, key)) return std::nullopt;
        if (!plain && good_) {
            if (point_.line.number != PointLine::Number::whole) return point_.line.raw_of(written.value);
            return within(point_.line.number_at(written.value), written, key);
        }
        constexpr double widest = 0x1p32;
        if (plain && written.value == std::floor(written.value) && std::abs(written.value) <= widest)
            return within(written.value, written, key);
        if (good_)
            problem(key, "config.wrong_type", fmt::format("{:g} for `{}` is no whole number", written.value, key),
                    point_.unit.empty() ? "write the raw number, such as 1"
                                        : fmt::format("write it with its unit, such as `1 {}`", point_.unit));
        return std::nullopt;
    }

    Reader& reader_;
    const IoEntry& entry_;
    bool input_, good_ = true;
    unsigned bits_ = 0;  // of its object; 0: not known
    const PointPlace& place_;
    std::string here_;
    runtime::IoPoint point_;
    const DeviceChannel* channel_ = nullptr;
};

}  // namespace

runtime::IoPoint make_point(Reader& reader, const IoEntry& entry, IoDirection direction, const PointPlace& place,
                            const std::vector<runtime::IoPoint>& others) {
    return PointBuilder(reader, entry, direction, place).build(others);
}

}  // namespace taktwerk::config
