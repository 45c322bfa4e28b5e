#pragma once
// A drive's own alarm in the machine's words: which drive, and what its profile says (axes/port/alarm_words.hpp). Made outside the cycle.

#include "axes/port/find_alarm.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// Words of the row that fits code and detail. Where no single row does, cause and remedy of `text` stay. Leaves the source, the name and the
/// reaction alone.
void tell_drive_alarm(AlarmText& text, const AxisBinding& axis, const axes::ShownAlarm& alarm);

}  // namespace taktwerk::runtime
