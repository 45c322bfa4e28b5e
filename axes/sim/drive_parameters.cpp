#include "axes/sim/drive_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/sim/cia402_axis.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::axes::sim {

namespace {

/// Commands and set-points of CiA 402-2, and the probes that a master arms: no drive comes up with them.
constexpr ParameterAddress not_kept[] = {{0x6040, 0}, {0x6060, 0}, {0x6071, 0}, {0x607A, 0}, {0x60B0, 0},
                                         {0x60B1, 0}, {0x60B2, 0}, {0x60B8, 0}, {0x60FE, 1}, {0x60FF, 0}};

/// 1010h and 1011h: nothing but the signature is taken (CiA 301 7.5.2.13). A parameter of the maker's goes back to 0.
constexpr bool takes_signature_only(ParameterAddress at) noexcept { return at.index < 0x2000; }

std::vector<ParameterAddress> never_kept(const DriveProfile& profile) {
    std::vector<ParameterAddress> out(std::begin(not_kept), std::end(not_kept));
    if (profile.alarm_history.select.index != 0) out.push_back(profile.alarm_history.select);
    return out;
}

}  // namespace

DriveParameters::DriveParameters(const DriveProfile& profile)
    : orders_(profile.orders),
      history_objects_(profile.alarm_history),
      limits_switch_(profile.limits_switch),
      object_offset_(profile.object_offset),
      axes_(profile.axes),
      store_(profile, never_kept(profile)) {}

void DriveParameters::power_on(ecat::sim::ObjectDictionary& dictionary) {
    dictionary_ = &dictionary;
    store_.power_on();
    restart_pending_ = false;
    for (const auto& cell : store_.cells())
        if (cell.change != ParameterChange::never)
            if (auto* entry = dictionary.find(cell.address.index, cell.address.sub)) entry->set(cell.ram);
    const auto find = [&](ParameterAddress at) { return at.index ? dictionary.find(at.index, at.sub) : nullptr; };
    record_ = {find(history_objects_.select), find(history_objects_.code), find(history_objects_.time), find(history_objects_.speed)};
}

unsigned DriveParameters::axis_of(std::uint16_t index) const noexcept {
    return index < 0x6000 || object_offset_ == 0 ? 0u : std::min<unsigned>((index - 0x6000u) / object_offset_, axes_ - 1u);
}

bool DriveParameters::is_order(ParameterAddress at) const noexcept {
    return std::any_of(orders_.begin(), orders_.end(), [&](const auto& order) { return order.address == at; });
}

std::uint32_t DriveParameters::refuse(std::uint16_t index, std::uint8_t sub, std::int64_t value, bool motor_powered) const {
    const ParameterAddress at{index, sub};
    const bool rests = value == 0 && !takes_signature_only(at);
    const bool known = std::any_of(orders_.begin(), orders_.end(),
                                   [&](const auto& order) { return order.address == at && (order.value == value || rests); });
    if (is_order(at) && !known) return ecat::sdo_abort::cannot_store;  // CiA 301 7.5.2.13: a wrong signature
    return store_.refuse(at, value, motor_powered) == ParameterStore::Refusal::enabled ? ecat::sdo_abort::device_state : 0;
}

std::int64_t DriveParameters::value_of(unsigned axis, std::uint16_t index, std::uint8_t sub, std::int64_t otherwise) const noexcept {
    return dictionary_->value(static_cast<std::uint16_t>(index + axis * object_offset_), sub, otherwise);
}

void DriveParameters::written(std::uint16_t index, std::uint8_t sub, Instant now, Cia402Axis& axis) {
    const auto value = dictionary_->value(index, sub);
    if (is_order({index, sub})) {
        // What is read there is not what was written: SE-808X 6 prints 0.
        if (takes_signature_only({index, sub})) dictionary_->find(index, sub)->set(0);
        return obey({index, sub}, value, now, axis);
    }
    store_.write({index, sub}, value, now);
    restart_pending_ = store_.restart_pending();
    check_settings(axis_of(index), axis);
}

void DriveParameters::obey(ParameterAddress at, std::int64_t value, Instant now, Cia402Axis& axis) {
    for (const auto& order : orders_) {
        if (order.address != at) continue;
        const bool given = order.value == value;
        if (order.order == DriveOrder::emergency_stop) axis.cause(DriveAlarmKind::emergency_stop, given);
        if (!given) continue;
        switch (order.order) {
            case DriveOrder::emergency_stop: break;
            case DriveOrder::reset_alarm: axis.reset_alarm(); break;
            case DriveOrder::save_parameters: store_.save(now); break;
            case DriveOrder::restore_parameters: store_.restore_factory(now); break;
        }
    }
}

/// SV33-E E.D15: 607Dh:01 not below 607Dh:02; E.D16: 607Ch outside of them.
void DriveParameters::check_settings(unsigned axis, Cia402Axis& model) const noexcept {
    constexpr auto lowest = std::numeric_limits<std::int64_t>::min(), highest = std::numeric_limits<std::int64_t>::max();
    const auto minimum = value_of(axis, 0x607D, 1, lowest), maximum = value_of(axis, 0x607D, 2, highest);
    const auto offset = value_of(axis, 0x607C, 0, 0);
    model.cause(DriveAlarmKind::limits_crossed, minimum >= maximum);
    model.cause(DriveAlarmKind::home_outside_limits, minimum < maximum && (offset < minimum || offset > maximum));
}

SoftwareLimits DriveParameters::software_limits() const noexcept {
    switch (limits_switch_.index ? store_.acting(limits_switch_).value_or(0) : 0) {
        case 1: return SoftwareLimits::on;
        case 2: return SoftwareLimits::after_homing;
        default: return SoftwareLimits::off;
    }
}

void DriveParameters::step(Instant now, Cia402Axis& first) noexcept {
    // Only what changes: somebody else may have provoked the same alarm.
    if (restart_pending_ != restart_warned_) first.cause(DriveAlarmKind::power_cycle_pending, restart_warned_ = restart_pending_);
    const bool too_often = store_.writes_too_often(now);
    if (too_often != storage_warned_) first.cause(DriveAlarmKind::parameter_storage, storage_warned_ = too_often);
    show_record(first);
}

void DriveParameters::show_record(Cia402Axis& first) noexcept {
    if (!record_.select) return;
    const auto& history = first.history();
    // 0 is the alarm that stands now; n the n-th before it.
    const auto chosen = record_.select->get();
    const bool stands = first.alarm_stands();
    AlarmHistory::Record shown;
    if (chosen > 0 || stands) shown = history.latest(static_cast<std::size_t>(stands ? chosen : chosen - 1));
    if (record_.code) record_.code->set(shown.shown);
    if (record_.time) record_.time->set(shown.since_power_on / std::chrono::milliseconds{100});
    if (record_.speed) record_.speed->set(std::llround(60.0 * shown.speed / first.counts_per_revolution()));
}

}  // namespace taktwerk::axes::sim
