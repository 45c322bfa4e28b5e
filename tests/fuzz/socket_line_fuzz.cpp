// Any bytes as lines of the command socket: each line gets at most one answer line that is JSON, and whatever reaches the machine
// is finite and names what the machine has.
#include <cmath>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "axes/excitation/excitation_plan.hpp"
#include "hmi_bridge/history/alarm_history.hpp"
#include "hmi_bridge/socket/json_requests.hpp"
#include "hmi_bridge/views/view_answers.hpp"
#include "runtime/recording/signal_ring.hpp"
#include "tests/fuzz/message_count.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi;

namespace {

/// Some rows for the scope: its words are numbers, infinite ones and none among them.
runtime::SignalRing& fuzz_rows() {
    using runtime::SignalGroup, runtime::SignalKind, runtime::SignalCell;
    static runtime::SignalRing ring{
        {{"time_s", "s", SignalKind::real, SignalGroup::machine, "", "", "", {0, 0, 64, SignalCell::Coding::integer, 1e9}},
         {"x.set_position", "mm", SignalKind::real, SignalGroup::axis, "x", "", "", {1, 0, 64, SignalCell::Coding::real, 1}},
         {"x.state", "", SignalKind::state, SignalGroup::axis, "x", "", "", {2, 3, 5, SignalCell::Coding::natural, 1}}},
        3,
        50,
        std::chrono::milliseconds{1}};
    for (std::uint64_t cycle = 1; ring.span().last < 80; ++cycle) {
        auto row = ring.begin(cycle);
        row.put(Duration{cycle * 1'000'000});
        row.put(cycle % 7 == 0 ? std::nan("") : cycle % 5 == 0 ? HUGE_VAL : static_cast<double>(cycle));
        row.put(cycle * 977);
        ring.commit();
    }
    return ring;
}

/// A page of the machine's builder with a value and a picture.
const ViewAnswers& views() {
    static const auto answers = [] {
        static const fuzz::ScratchFolder folder;
        folder.write("cell.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>");
        runtime::MachineConfig config;
        config.axes.emplace_back().axis.name = "x";
        ViewWidget bar, image;
        bar.kind = ViewWidget::Kind::value, bar.names = {{"x.actual_position"}};
        image.kind = ViewWidget::Kind::image, image.image = "cell.svg", image.image_path = (folder.path() / "cell.svg").string();
        View view;
        view.name = "cell", view.title = {"Cell", "Cell"}, view.rows = {{bar, image}};
        auto made = ViewAnswers::make({view}, view_values_of(config));
        if (!made) std::abort();
        return *made;
    }();
    return answers;
}

/// What is the same for every input, and dear to make. An axis that may be measured and was, by a few samples.
struct Played {
    Played() {
        auto& limits = machine.its_config.limits;
        limits.velocity = 200, limits.acceleration = limits.deceleration = 5000, limits.jerk = 100000;
        limits.position_min = 0, limits.position_max = 800;
        machine.its_config.name = "x";
        for (auto& axis : machine.snapshot.axes) axis.set_position = 400, axis.manual_slow = 20, axis.manual_fast = 50;
        axes::ExcitationBounds bounds{
            .start = 400, .velocity = 200, .usual_velocity = 20, .acceleration = 5000, .stop = 5000, .jerk = 100000};
        bounds.revolution = 10, bounds.cycle = 1e-3;
        axes::MeasureOrder order{axes::MeasureKind::ramp};
        order.distance = 10;
        machine.snapshot.measure = {1, 0, false, runtime::MeasureEnd::done, axes::ErrorId::none, 1, 0, axes::ExcitationPlan{order, bounds}};
        profile.parameters.resize(2);
        machine.its_times.cycle = &cycle;
        machine.drives = {{nullptr, &profile}};
        machine.rows = &fuzz_rows();
        log->add("a line\n\xff");
    }
    void forget() {
        machine.submitted.clear(), machine.answers.clear(), machine.stops.clear(), machine.releases.clear(), machine.samples.clear();
        axes::MeasureSample sample;
        sample.run = 1, sample.fresh = true;
        for (sample.cycle = 500; sample.cycle < 530; ++sample.cycle)
            sample.set_position = sample.actual_position = 0.01 * static_cast<double>(sample.cycle), machine.samples.push_back(sample);
    }
    test::FakeMachine machine;
    runtime::CycleHistograms cycle;
    axes::DriveProfile profile;
    std::shared_ptr<LogTail> log = std::make_shared<LogTail>();
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // What is longer is no deeper, only slower: a few lines show what one does to the next.
    if (size > 1024) return -1;
    static Played played;
    played.forget();
    auto& machine = played.machine;
    Gateway gateway(machine);
    JsonRequests requests(gateway, machine, [] { return std::int64_t{1'800'000'000'000'000}; });
    AlarmHistory history(
        "/nowhere/alarms.sqlite", 10, [](const AlarmFact& fact) { return machine.describe(fact); }, nullptr);
    requests.set_history(&history);
    requests.set_views(views());
    requests.set_simulate([](const std::string& line) {
        return line.empty() ? Result<void>{Error{"fault.unknown", "", "nothing", "say it"}} : Result<void>{};
    });
    gateway.observe(true);
    requests.observe(&machine.snapshot);
    requests.set_log(played.log);
    requests.on_open(1, {});
    Instant now{std::chrono::seconds{1}};

    static fuzz::MessageCount count;
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    for (int lines = 0; lines < 8 && !rest.empty(); ++lines) {
        const auto end = std::min(rest.find('\n'), rest.size());
        const auto before = machine.submitted.size();
        count.one();
        requests.on_line(1, rest.substr(0, end), now);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (machine.submitted.size() > before + 1) std::abort();
        if (machine.submitted.size() > before) {
            const auto& command = machine.submitted.back();
            if (!std::isfinite(command.value) || !std::isfinite(command.value2)) std::abort();
            if (command.axis != 0xFFFF && command.axis >= machine.its_layout.axes.size()) std::abort();
            const bool forces = command.action == runtime::OperatorAction::force || command.action == runtime::OperatorAction::unforce;
            const auto points = command.flag ? machine.its_layout.outputs.size() : machine.its_layout.inputs.size();
            if (forces && command.index >= points) std::abort();
            // Letting go is never too late.
            const bool lets_go = command.action == runtime::OperatorAction::set_value && command.value == 0;
            if (!lets_go && command.expires <= now - std::chrono::nanoseconds{1}) std::abort();
            if (command.action == runtime::OperatorAction::set_value &&
                (command.index >= machine.its_layout.variables.size() || !machine.its_layout.variables[command.index].takes(command.value)))
                std::abort();
            machine.answer(runtime::Answer::accepted);
        }
        now += std::chrono::milliseconds{5};
        gateway.step(now);
        requests.step(now);
        while (const auto reply = gateway.next_reply()) requests.deliver(*reply);
        history.work(now);
        requests.step(now);
        int answers = 0;
        while (const auto line = requests.next_line()) {
            if (++answers > 1 || !nlohmann::json::accept(line->text) || line->text.find('\n') != std::string::npos) std::abort();
        }
    }
    requests.on_close(1);
    return 0;
}
