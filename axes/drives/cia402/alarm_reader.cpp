#include "axes/drives/cia402/alarm_reader.hpp"

#include <algorithm>

#include "axes/port/find_alarm.hpp"

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
    if (alarm_.warning != warning) {
        alarm_.warning = warning;
        look_up();
    }
    if (alarm_.detail_known || request_ == 0) return;
    const auto answer = answer_.load(std::memory_order_acquire);
    if (static_cast<std::uint32_t>(answer >> 32) != request_) return;
    alarm_.detail_known = true;
    alarm_.detail = static_cast<std::uint32_t>(answer);
    look_up();
}

// Only when what the drive shows changes. As long as alarms share the code and the detail is not read, it can be any of them.
void AlarmReader::look_up() noexcept {
    ShownAlarm shown{alarm_.code, std::nullopt, alarm_.warning ? ShownAlarm::As::warning : ShownAlarm::As::fault};
    if (alarm_.detail_known) shown.detail = alarm_.detail;
    const auto found = find_alarm(profile_, shown);
    alarm_.entry = found.row ? static_cast<std::int32_t>(found.row - profile_.alarms.data()) : -1;
    alarm_.resettable = found.resettable;
    alarm_.whole_drive = found.whole_drive;
    alarm_.kind = found.kind;
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
