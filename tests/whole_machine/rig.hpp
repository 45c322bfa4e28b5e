#pragma once
// A machine of config/machines/ in virtual time with everything around it: disk, history of alarms, recordings, an operator, and the oracles that look at
// each of its cycles:
//
//   told = shown       what each drive is told through the frames is what its axis shows, and set-points are continuous within the limits of the axis in place,
//                      velocity, acceleration and jerk (tests/runtime/drive_oracle.hpp)
//   positions exact    what an axis shows at rest is its drive's counts, digit by digit, and the same ever since its reference (places.hpp)
//   explained          each alarm has something that happened just before and may cause it (causes.hpp)
//   answered           each command is answered within 50 cycles

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "hmi_bridge/history/alarm_history.hpp"
#include "runtime/flight/flight_recorder.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/whole_machine/causes.hpp"
#include "tests/whole_machine/loading.hpp"
#include "tests/whole_machine/places.hpp"
#include "tests/whole_machine/private_disk.hpp"

namespace taktwerk::whole {

using namespace std::chrono_literals;

/// Something that was done to the machine, and may be the reason for an alarm.
struct Happening {
    std::variant<Trouble, Deed> what;
    std::string at;  ///< axis, slave, program, line; empty: the whole machine
    Instant from{};
    std::optional<Instant> to{};  ///< empty: it lasts
    [[nodiscard]] std::string text() const;
};

class Rig {
public:
    /// What comes of something may come that much later, at most.
    static constexpr Duration aftermath = 8s;

    explicit Rig(std::string_view machine);
    ~Rig();
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    // --- time -----------------------------------------------------------------------------------------------------------------------
    /// Also of a machine that has stopped.
    void cycle() {
        (void)m.runner->run_until([] { return true; }, m.machine->config().cycle);
    }
    void run(Duration time) {
        for (const auto end = now() + time; now() < end && !over();) cycle();
    }
    template <class Condition>
    bool until(Condition condition, Duration patience) {
        for (const auto end = now() + patience; now() < end && !over();) {
            if (condition()) return true;
            cycle();
        }
        return condition();
    }
    [[nodiscard]] Instant now() const { return m.clock.now(); }
    /// Too much is wrong to go on.
    [[nodiscard]] bool over() const { return problems.size() > 8; }

    // --- hands ----------------------------------------------------------------------------------------------------------------------
    /// Its number; 0: the inbox is full.
    std::uint64_t submit(runtime::OperatorCommand command);
    std::uint64_t submit(runtime::OperatorAction action, std::uint16_t axis = 0xFFFF, bool flag = false, double value = 0,
                         double value2 = 0);
    void mode(runtime::Mode mode);
    /// Of the newest command that was answered.
    [[nodiscard]] const runtime::CommandAnswer& answer() const { return last_answer_; }
    /// Something is done from now on; handle for ended().
    std::size_t begins(std::variant<Trouble, Deed> what, std::string at = {});
    void ended(std::size_t happening);
    void happens(std::variant<Trouble, Deed> what, std::string at = {}) { ended(begins(what, std::move(at))); }

    // --- what is wrong --------------------------------------------------------------------------------------------------------------
    void problem(std::string text) { problems.push_back(fmt::format("{:.3f} s: {}", to_seconds(now().time_since_epoch()), text)); }
    /// Of all oracles so far; they look on.
    void gather();
    [[nodiscard]] std::string story() const;

    [[nodiscard]] bool in_operation() const;  ///< bus in OP, every slave exchanged
    [[nodiscard]] bool any_in_error();
    [[nodiscard]] std::string standing();  ///< alarms, in words
    [[nodiscard]] const Places& places() const { return places_; }

    PrivateDisk disk;
    runtime::testing::TestMachine m;
    std::vector<std::string> problems;
    std::deque<std::string> log;                    ///< the newest of what was done and what came of it
    std::map<std::string, long, std::less<>> seen;  ///< alarms by their names
    Reaction strongest = Reaction::none;            ///< of all alarms since it was set
    std::map<std::string, long, std::less<>> done;  ///< troubles by their names
    long commands = 0, answers = 0;

private:
    void each_cycle();
    void look_at_alarms(const runtime::Snapshot& snapshot);
    void look_at_answers();
    [[nodiscard]] bool explained(std::string_view alarm, const AlarmFact& fact);
    [[nodiscard]] bool stopped_at_its_switch(std::string_view alarm, const AlarmFact& fact);
    [[nodiscard]] bool has_lost_steps(std::string_view alarm, const AlarmFact& fact) const;
    [[nodiscard]] bool is_at(const AlarmFact& fact, const std::string& at) const;
    void tell(std::string line);

    std::optional<hmi::AlarmHistory> history_;
    std::unique_ptr<runtime::FlightRecorder> recorder_;
    Places places_;
    std::deque<Happening> happenings_;
    std::size_t forgotten_ = 0;  // happenings that are long over
    /// A command without an answer yet. It does nothing, and explains nothing, before it is accepted.
    struct Given {
        std::uint64_t cycle = 0;
        std::optional<Deed> deed{};
        std::string at{};
        std::uint16_t axis = 0xFFFF;
        bool asks_for_reference = false;
    };
    void accepted(const Given& given);
    using Known = std::tuple<AlarmId, AlarmSource, std::uint16_t, std::int64_t>;
    std::vector<Known> known_, still_;           // alarms of the cycle before, and of this one
    std::map<std::uint64_t, Given> unanswered_;  // by number
    int shaking_ = 0;                            // troubles that last and may cost a motor without an encoder steps
    runtime::CommandAnswer last_answer_;
    std::uint64_t sequence_ = 0, cycles_ = 0;
};

}  // namespace taktwerk::whole
