#include "axes/sim/drive_alarm_codes.hpp"

#include "axes/sim/communication_error.hpp"

namespace taktwerk::axes::sim {

namespace {

struct UsualCode {
    DriveAlarmKind kind;
    AlarmCode alarm;
};
constexpr UsualCode usual_codes[] = {
    {DriveAlarmKind::following_error, {0x8611}}, {DriveAlarmKind::setpoint_leap, {0x0424}},  {DriveAlarmKind::undervoltage, {0x3220}},
    {DriveAlarmKind::communication, {0x7500}},   {DriveAlarmKind::overspeed, {0x8400}},      {DriveAlarmKind::overload, {0x3230}},
    {DriveAlarmKind::encoder, {0x7305, false}},  {DriveAlarmKind::start_too_fast, {0x0417}}, {DriveAlarmKind::negative_limit, {0x5444}},
    {DriveAlarmKind::positive_limit, {0x5443}},
};

}  // namespace

DriveAlarmCodes::DriveAlarmCodes(const DriveProfile& profile) {
    const auto at = [&](DriveAlarmKind kind) -> AlarmCode& { return codes_[static_cast<std::size_t>(kind)]; };
    for (auto row = profile.alarms.rbegin(); row != profile.alarms.rend(); ++row) at(row->kind) = alarm_code(*row);
    for (const auto& usual : usual_codes)
        if (at(usual.kind).code == 0) at(usual.kind) = usual.alarm;
    if (profile.behaviour.state.error_sub_code.index == 0) return;
    auto& communication = at(DriveAlarmKind::communication);
    communication.detail = communication_error::watchdog;
    at(DriveAlarmKind::left_operational) = {communication.code, communication.resettable, communication_error::general};
}

AlarmCode first_alarm(const DriveProfile& profile, DriveAlarmKind kind, const AlarmCode& otherwise) noexcept {
    for (const auto& row : profile.alarms)
        if (row.kind == kind) return {row.code, row.resettable, row.detail};
    return otherwise;
}

}  // namespace taktwerk::axes::sim
