#include "axes/drives/cia402/settings_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "axes/drives/cia402/words.hpp"
#include "axes/port/drive_scale.hpp"

namespace taktwerk::axes::cia402 {

namespace {

constexpr double seconds_per_minute = 60.0;

constexpr std::string_view ask_again = "Nothing is wrong with it as far as anybody knows: a reset reads it again";

constexpr std::string_view not_read(bool silent) {
    return silent ? "could not be read: its mailbox did not answer, twice" : "could not be read: it refuses";
}

std::string shown(ParameterAddress object) {
    return object.sub ? fmt::format("{:04X}h:{:02X}", object.index, object.sub) : fmt::format("{:04X}h", object.index);
}

std::string shown(Duration cycle) { return fmt::format("{} us", to_seconds(cycle) * 1e6); }

std::int64_t number(const std::vector<std::byte>& data, bool is_signed) noexcept {
    std::uint64_t value = 0;
    const std::size_t size = std::min<std::size_t>(8, data.size());
    for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint64_t>(data[i]) << (8 * i);
    if (!is_signed || size == 0) return static_cast<std::int64_t>(value);
    const auto unused = static_cast<unsigned>(64 - 8 * size);
    return static_cast<std::int64_t>(value << unused) >> unused;
}

bool applies(SettingApplies when, bool clocks) noexcept {
    return when == SettingApplies::always || (when == SettingApplies::with_clocks) == clocks;
}

}  // namespace

SettingsCheck::SettingsCheck(const DriveProfile& profile, std::uint16_t offset, Duration cycle, AxisWants wants)
    : profile_(profile), offset_(offset), cycle_(cycle), wants_(std::move(wants)), velocity_(profile.velocity_counts_per_unit) {
    for (const auto& row : profile_.required_settings) want(row.object);
    want(profile_.units.object);
    want(profile_.units.counts_per_revolution);
    for (const auto& setting : wants_.stored) want(setting.object);
    if (wants_.counts_per_revolution != 0)
        for (const auto& object : scale_objects(profile_.scale)) want(object);
}

void SettingsCheck::want(ParameterAddress object) {
    if (object.index != 0 && !reading(object)) readings_.push_back({object, 0, false});
}

const SettingsCheck::Reading* SettingsCheck::reading(ParameterAddress object) const noexcept {
    for (const auto& r : readings_)
        if (r.object.index == object.index && r.object.sub == object.sub) return &r;
    return nullptr;
}

void SettingsCheck::online(bool now) noexcept {
    if (now && !online_) {
        came_.fetch_add(1, std::memory_order_acq_rel);
        wanted_.fetch_add(1, std::memory_order_acq_rel);
    }
    online_ = now;
}

void SettingsCheck::reset(bool asked) noexcept {
    if (asked && !reset_asked_ && verdict() == Verdict::refused) wanted_.fetch_add(1, std::memory_order_acq_rel);
    reset_asked_ = asked;
}

void SettingsCheck::changed(ParameterAddress address) noexcept {
    if (!reading(address)) return;
    for (const auto& row : profile_.parameters)
        if (row.address == address && row.waits_for_restart() && part_of_scale(address)) waiting_.push_back(address);
    wanted_.fetch_add(1, std::memory_order_acq_rel);
}

SettingsCheck::Verdict SettingsCheck::verdict() const noexcept {
    if (readings_.empty()) return Verdict::fits;
    if (!online_) return Verdict::unknown;  // frames reach a drive in OP before anybody has heard that it is there
    const auto judged = judged_.load(std::memory_order_acquire);
    if (static_cast<std::uint32_t>(judged >> 8) != wanted_.load(std::memory_order_acquire)) return Verdict::unknown;
    return static_cast<Verdict>(judged & 0xFFu);
}

void SettingsCheck::step(ecat::Master& bus, std::size_t slave) {
    if (readings_.empty()) return;
    if (ticket_ != 0) {
        const auto answer = bus.poll(ticket_);
        if (!answer) return;
        ticket_ = 0;
        take(readings_[next_], *answer, bus.slave(slave));
    }
    const auto wanted = wanted_.load(std::memory_order_acquire);
    if (const auto times = came_.load(std::memory_order_acquire); times != seen_coming_) seen_coming_ = times, waiting_.clear();
    if (wanted != under_way_) {  // from the start: what was read before may be of another time
        under_way_ = wanted;
        next_ = 0;
        again_ = false;
    } else if (wanted == static_cast<std::uint32_t>(judged_.load(std::memory_order_relaxed) >> 8)) {
        return;
    }
    if (next_ < readings_.size()) {
        const auto object = readings_[next_].object;
        const auto index = object_of_axis(object.index, offset_);
        ticket_ = bus.upload(slave, index, object.sub);
        return;
    }
    problems_.clear();
    judge(bus.slave(slave));
    const auto verdict = problems_.empty() ? Verdict::fits : Verdict::refused;
    judged_.store(static_cast<std::uint64_t>(under_way_) << 8 | static_cast<std::uint8_t>(verdict), std::memory_order_release);
}

/// A question that a mailbox has swallowed is asked once more: it was stuck, or the drive came up just then. Swallowed twice: nothing else is asked.
void SettingsCheck::take(Reading& reading, const Result<ecat::SdoResult>& answer, const ecat::SlaveConfig& slave) {
    reading.known = answer.ok();
    reading.silent = !answer.ok() && answer.error().code != "sdo.abort";
    if (reading.known) reading.value = number(answer.value().data, is_signed(slave, reading.object));
    const bool twice = reading.silent && again_;
    again_ = reading.silent && !twice;
    if (again_) return;
    ++next_;
    if (!twice) return;
    for (; next_ < readings_.size(); ++next_) readings_[next_].known = false, readings_[next_].silent = true;
}

bool SettingsCheck::is_signed(const ecat::SlaveConfig& slave, ParameterAddress object) const noexcept {
    if (slave.device)
        for (const auto& entry : slave.device->objects)
            if (entry.index == object.index && entry.sub == object.sub) return ecat::is_signed(entry.type);
    return false;
}

void SettingsCheck::judge(const ecat::SlaveConfig& slave) {
    const auto say = [&](ParameterAddress object, std::string_view text, std::string_view found, std::string_view remedy,
                         std::string_view section) {
        problems_.push_back(fmt::format("slave '{}': {} ({} {}). {} [manual {}]", slave.name, text, shown(object), found, remedy, section));
    };
    for (const auto& row : profile_.required_settings) {
        if (!applies(row.when, slave.dc)) continue;
        const auto& r = *reading(row.object);
        const auto place = static_cast<std::size_t>(r.value);
        if (!r.known) {
            say(row.object, row.text, not_read(r.silent), r.silent ? ask_again : row.remedy, row.section);
        } else if (row.cycles.empty()) {
            if (std::find(row.values.begin(), row.values.end(), r.value) == row.values.end())
                say(row.object, row.text, fmt::format("reads {}", r.value), row.remedy, row.section);
        } else if (r.value < 0 || place >= row.cycles.size()) {
            say(row.object, row.text, fmt::format("reads {}, which is no cycle", r.value), row.remedy, row.section);
        } else if (row.cycles[place] != cycle_) {
            say(row.object, row.text,
                fmt::format("reads {}: {}; the bus exchanges every {}", r.value, shown(row.cycles[place]), shown(cycle_)), row.remedy,
                row.section);
        }
    }
    judge_stored(slave);
    judge_scale(slave);
    if (profile_.units.object.index != 0) judge_units(slave);
}

std::string SettingsCheck::named(ParameterAddress object) const {
    for (const auto& row : profile_.parameters)
        if (row.address == object) return row.parameter.empty() ? fmt::format("{} ({})", shown(object), row.name) : row.parameter;
    return shown(object);
}

bool SettingsCheck::part_of_scale(ParameterAddress object) const noexcept {
    const auto objects = scale_objects(profile_.scale);
    return wants_.counts_per_revolution != 0 && std::find(objects.begin(), objects.end(), object) != objects.end();
}

void SettingsCheck::judge_stored(const ecat::SlaveConfig& slave) {
    for (const auto& setting : wants_.stored) {
        const auto& r = *reading(setting.object);
        if (r.known && r.value == setting.value) continue;
        const auto found = r.known ? fmt::format("reads {}", r.value) : std::string{not_read(r.silent)};
        problems_.push_back(fmt::format("slave '{}': {} shall be {} by `stored`, and {}. {}", slave.name, named(setting.object),
                                        setting.value, found, r.silent ? ask_again : setting.remedy));
    }
}

/// What the objects do not tell is said by `taktwerk check`, once: nobody can hold an axis back for it.
void SettingsCheck::judge_scale(const ecat::SlaveConfig& slave) {
    if (wants_.counts_per_revolution == 0) return;
    const auto& scale = profile_.scale;
    const auto refuse = [&](const std::string& why) {
        problems_.push_back(fmt::format("slave '{}': {}. {} [manual {}]", slave.name, why, scale.remedy, scale.section));
    };
    auto waiting = waiting_;
    for (const auto& sdo : slave.startup)
        for (const auto& row : profile_.parameters)
            if (row.waits_for_restart() && part_of_scale(row.address) && sdo.sub == row.address.sub &&
                sdo.index == row.address.index + offset_)
                waiting.push_back(row.address);
    for (const auto& object : waiting)
        refuse(fmt::format(
            "{} was written and counts after a restart only: what a turn of the motor is for the drive now, nobody knows. Store "
            "it, switch the drive off and on",
            named(object)));
    const auto found = scale_of(scale, [&](ParameterAddress object) -> std::optional<std::int64_t> {
        const auto* r = reading(object);
        return r != nullptr && r->known ? std::optional{r->value} : std::nullopt;
    });
    if (!found || found->is(wants_.counts_per_revolution)) return;
    refuse(fmt::format(
        "a turn of the motor is {:.10g} counts for the drive ({}), and {} for the axis (`gearing`): it would travel {:.4g} times "
        "as far as it shows",
        found->value(), scale_words(profile_), wants_.counts_per_revolution,
        static_cast<double>(wants_.counts_per_revolution) / found->value()));
}

void SettingsCheck::judge_units(const ecat::SlaveConfig& slave) {
    const auto& units = profile_.units;
    const auto* chosen = reading(units.object);
    const UnitVariant* variant = nullptr;
    for (const auto& v : units.variants)
        if (chosen->known && v.value == chosen->value) variant = &v;
    const auto say = [&](std::string text) { problems_.push_back(fmt::format("slave '{}': {}", slave.name, text)); };
    if (!variant) return say(fmt::format("{} chooses its units, and its value is not known; no scaling is possible", shown(units.object)));

    double scale = profile_.velocity_counts_per_unit;
    if (variant->velocity == VelocityUnit::rpm) {
        const auto* turn = reading(units.counts_per_revolution);
        if (!turn || !turn->known || turn->value <= 0)
            return say(
                fmt::format("{} = {}: velocities are in rpm, and {} does not tell the counts of a revolution. Set it, or other units",
                            shown(units.object), variant->value, shown(units.counts_per_revolution)));
        scale = seconds_per_minute / static_cast<double>(turn->value);
    }
    if (variant->acceleration == AccelerationUnit::time || variant->velocity == VelocityUnit::rpm)
        for (const auto& sdo : slave.startup)
            if (sdo.index == 0x6099 + offset_ || sdo.index == 0x609A + offset_ || sdo.index == 0x6083 + offset_ ||
                sdo.index == 0x6084 + offset_)
                return say(
                    fmt::format("{} = {}: {:04X}h was written in counts, but the drive takes velocities in rpm and accelerations as a time "
                                "in ms to a rated speed that no object tells. Set other units, or home by the runtime",
                                shown(units.object), variant->value, sdo.index));
    velocity_.store(scale, std::memory_order_relaxed);
    hidden_.store(variant->status_hidden, std::memory_order_relaxed);
}

}  // namespace taktwerk::axes::cia402
