#include "tests/whole_machine/long_day.hpp"

#include <malloc.h>

#include <numeric>

#include "tests/whole_machine/recovery.hpp"

namespace taktwerk::whole {

LongDay::LongDay(std::string machine, std::uint32_t seed) : random_(seed), rig_(machine), troubles_(rig_, random_), hands_(rig_, random_) {
    rig_.m.machine->start_bus();
    const auto up = [&] { return rig_.m.machine->bus().phase() == ecat::Master::Phase::operational; };
    if (!rig_.until(up, 60s)) rig_.problem("it does not come up: " + rig_.m.machine->bus_progress());
    rig_.happens(Deed::restart);
    if (const auto armed = rig_.m.machine->arm(); !armed) rig_.problem("not armed: " + armed.error().text());
}

LongDay::Hour LongDay::so_far() const {
    Hour hour;
    hour.at = rig_.now().time_since_epoch();
    hour.heap = ::mallinfo2().uordblks;
    hour.troubles = struck_;
    hour.commands = rig_.commands;
    hour.alarms = std::accumulate(rig_.seen.begin(), rig_.seen.end(), 0L, [](long sum, const auto& one) { return sum + one.second; });
    hour.compared = rig_.places().compared();
    hour.references = rig_.places().references();
    return hour;
}

void LongDay::live(Duration time, Duration every, const std::function<void(const Hour&)>& told) {
    const auto begin = rig_.now(), end = begin + time;
    auto next = begin + every;
    automatic();
    while (rig_.now() < end && rig_.problems.empty()) {
        work(between(5s, 40s));
        if (below(4) == 0) {
            by_hand(between(5s, 25s));
            bring_back();
        }
        rig_.gather();
        if (rig_.now() < next) continue;
        next += every;
        hours_.push_back(so_far());
        told(hours_.back());
    }
    troubles_.heal();
    rig_.gather();
}

void LongDay::one_cycle() {
    troubles_.step();
    rig_.cycle();
}

/// It works until something happens; then somebody comes and brings it back.
void LongDay::work(Duration time) {
    for (const auto end = rig_.now() + time; rig_.now() < end && rig_.problems.empty();) {
        if (below(8000) == 0) hands_.do_anything();
        one_cycle();
    }
    const int count = below(4) == 0 ? 2 : 1;
    for (int i = 0; i < count; ++i) {
        auto trouble = static_cast<Trouble>(below(trouble_names.size()));
        if (!troubles_.possible(trouble)) continue;
        (void)troubles_.strike(trouble);
        ++struck_;
    }
    for (const auto end = rig_.now() + 10s; !troubles_.over() && rig_.now() < end;) one_cycle();
    for (const auto end = rig_.now() + between(200ms, 3s); rig_.now() < end;) one_cycle();
    bring_back();
}

void LongDay::by_hand(Duration time) {
    rig_.mode(below(2) == 0 ? runtime::Mode::manual : runtime::Mode::setup);
    rig_.run(50ms);
    (void)rig_.submit(runtime::OperatorAction::power, 0xFFFF, true);
    for (const auto end = rig_.now() + time; rig_.now() < end && rig_.problems.empty();) {
        if (below(150) == 0) hands_.do_anything();
        one_cycle();
    }
}

void LongDay::bring_back() {
    troubles_.heal();
    if (recover(rig_, hands_)) automatic();
}

void LongDay::automatic() {
    rig_.mode(runtime::Mode::automatic);
    rig_.run(100ms);
    for (std::uint16_t i = 0; i < rig_.m.machine->layout().programs.size(); ++i)
        (void)rig_.submit(runtime::OperatorAction::program_start, i);
    begin_work(rig_);
}

void LongDay::end() {
    troubles_.heal();
    (void)end_in_order(rig_);
    rig_.gather();
}

std::string LongDay::table() const {
    std::string out = "troubles:";
    for (const auto& [what, count] : rig_.done) out += fmt::format(" {} {},", what, count);
    out.back() = '\n';
    out += "alarms, each explained:";
    for (const auto& [what, count] : rig_.seen) out += fmt::format(" {} {},", what, count);
    out.back() = '\n';
    return out;
}

}  // namespace taktwerk::whole
