#pragma once
// What `taktwerk run` says while a machine runs: phases, alarms as they come and go, programs. One line an event, with the machine
// time in front, for a person who watches or reads it later.

#include <functional>
#include <string>
#include <vector>

#include "apps/machine/log_entry.hpp"
#include "runtime/machine/machine.hpp"

namespace taktwerk::apps {

class MachineLog {
public:
    using Sink = std::function<void(std::string)>;  ///< whole lines
    /// To standard output, at once.
    static void print(std::string lines);
    MachineLog(runtime::Machine& machine, Instant start, LogSink sink) : machine_(machine), start_(start), sink_(std::move(sink)) {}
    /// As lines. `json`: one object a line instead of text.
    MachineLog(runtime::Machine& machine, Instant start, bool json, Sink sink = &MachineLog::print);

    /// Compares with what was said before.
    void step(Instant now, const runtime::Snapshot* snapshot);
    /// Any thread, if the sink is for any.
    void say(Instant now, const std::string& event, const std::string& text) const;

private:
    void bus_notes(Instant now);
    void alarms(Instant now, const runtime::Snapshot& snapshot);
    /// An alarm to which the machine does not react: it is information, and it may come again each second.
    void note(Instant now, const AlarmFact& fact, bool is_new, const std::string& event = "note");
    /// What came and went between two looks.
    void passed_alarms(Instant now, const runtime::Snapshot& snapshot);
    void events(Instant now, const runtime::Snapshot& snapshot);
    void emergency(Instant now, const runtime::Snapshot& snapshot);
    void say_alarm(Instant now, const std::string& event, const runtime::AlarmText& words);

    struct Known {
        AlarmFact fact;
        Instant since{};
        bool standing = false, is_note = false;
        std::uint32_t count = 0;
        std::string said;  // in English
    };
    struct Noted {
        AlarmFact fact;
        Instant said_at{};
        std::uint32_t unsaid = 0;
    };
    runtime::Machine& machine_;
    Instant start_;
    LogSink sink_;
    std::string progress_;
    std::vector<axes::AxisState> states_;
    std::vector<bool> homed_;
    std::vector<runtime::ProgramState> programs_;
    std::vector<Known> known_;
    std::vector<Noted> notes_;
    std::uint64_t notes_of_bus_ = 0;  // how many were said
    std::uint64_t last_event_ = 0;    // its number
    std::uint64_t next_passed_ = 0;   // likewise
    std::uint64_t events_dropped_ = 0;
    runtime::Mode mode_ = runtime::Mode::manual;
    bool first_ = true;
    enum class Emergency : std::uint8_t { none, pressed, unread } emergency_ = Emergency::none;
};

}  // namespace taktwerk::apps
