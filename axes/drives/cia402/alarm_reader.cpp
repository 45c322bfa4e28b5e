#include "axes/drives/cia402/alarm_reader.hpp"

#include <algorithm>

namespace taktwerk::axes::cia402 {

void AlarmReader::note(bool present, std::uint16_t code, bool warning) noexcept {
    if (!present) {
        if (!present_) return;
        present_ = false;
        alarm_ = DriveAlarm{};
        request_ = 0;
        wanted_.store(0, std::memory_order_relaxed);
        return;
    }
    if (!present_ || alarm_.code != code) {
        present_ = true;
        alarm_ = DriveAlarm{};
        alarm_.code = code;
        alarm_.warning = warning;
        request_ = 0;
        if (detail_index_ != 0 && code != 0) {
            if (++occurrence_ == 0) occurrence_ = 1;
            request_ = static_cast<std::uint32_t>(occurrence_) << 16 | code;
        }
        look_up();
        wanted_.store(request_, std::memory_order_release);
        return;
    }
    alarm_.warning = warning;
    if (alarm_.detail_known || request_ == 0) return;
    const auto answer = answer_.load(std::memory_order_acquire);
    if (static_cast<std::uint32_t>(answer >> 32) != request_) return;
    alarm_.detail_known = true;
    alarm_.detail = static_cast<std::uint32_t>(answer);
    look_up();
}

// Only when the alarm changes; the table is bounded (a few hundred rows).
void AlarmReader::look_up() noexcept {
    alarm_.entry = -1;
    alarm_.resettable = true;
    alarm_.kind = DriveAlarmKind::other;
    const bool pending = request_ != 0 && !alarm_.detail_known;
    bool any_resettable = false;
    for (std::size_t i = 0; i < profile_.alarms.size(); ++i) {
        const auto& row = profile_.alarms[i];
        if (row.code != alarm_.code) continue;
        const bool exact = alarm_.detail_known && row.detail == alarm_.detail;
        any_resettable = any_resettable || row.resettable;
        if (alarm_.entry < 0 || exact) {
            alarm_.entry = static_cast<std::int32_t>(i);
            // Alarms that share a code may differ in this: as long as one of them clears, a reset is worth the attempt.
            alarm_.resettable = exact ? row.resettable : any_resettable;
            alarm_.whole_drive = row.whole_drive;
            alarm_.kind = row.kind;
        } else {
            alarm_.resettable = any_resettable;
            // Alarms that share a code mean different things: which one it is, is known with the detail only.
            if (pending && row.kind != alarm_.kind) alarm_.kind = DriveAlarmKind::other;
        }
        if (exact) break;
    }
}

void AlarmReader::step(ecat::Master& bus, std::size_t slave) {
    if (detail_index_ == 0) return;
    if (ticket_ == 0) {
        const auto wanted = wanted_.load(std::memory_order_acquire);
        if (wanted == 0 || wanted == asked_) return;
        asked_ = wanted;
        ticket_ = bus.upload(slave, detail_index_, profile_.alarm_detail_sub);
        return;
    }
    const auto answer = bus.poll(ticket_);
    if (!answer) return;
    ticket_ = 0;
    if (!answer->ok()) return;  // the plain code stays: a drive that cannot answer is no second fault
    std::uint32_t detail = 0;
    const auto& data = answer->value().data;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, data.size()); ++i) detail |= static_cast<std::uint32_t>(data[i]) << (8 * i);
    answer_.store(static_cast<std::uint64_t>(asked_) << 32 | detail, std::memory_order_release);
}

}  // namespace taktwerk::axes::cia402
