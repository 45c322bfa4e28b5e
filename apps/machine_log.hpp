#pragma once
// What `taktwerk run` says while a machine runs: phases, alarms as they come and go, programs. One line an event, with the machine
// time in front, for a person who watches or reads it later.

#include <string>
#include <vector>

#include "runtime/machine.hpp"

namespace taktwerk::apps {

class MachineLog {
public:
    /// `json`: one object a line instead of text.
    MachineLog(runtime::Machine& machine, Instant start, bool json) : machine_(machine), start_(start), json_(json) {}

    /// Compares with what was said before.
    void step(Instant now, const runtime::Snapshot* snapshot);
    void say(Instant now, const std::string& event, const std::string& text);

private:
    void alarms(Instant now, const runtime::Snapshot& snapshot);
    void events(Instant now, const runtime::Snapshot& snapshot);
    void say_alarm(Instant now, const std::string& event, const runtime::AlarmText& words);

    struct Known {
        AlarmFact fact;
        bool standing = false;
        std::uint32_t count = 0;
        std::string said;  // in English
    };
    runtime::Machine& machine_;
    Instant start_;
    bool json_;
    std::string progress_;
    std::vector<axes::AxisState> states_;
    std::vector<bool> homed_;
    std::vector<runtime::ProgramState> programs_;
    std::vector<Known> known_;
    std::uint64_t last_event_ = 0;  // its number
    std::uint64_t events_dropped_ = 0;
    runtime::Mode mode_ = runtime::Mode::manual;
    bool first_ = true, emergency_ = false;
};

}  // namespace taktwerk::apps
