// taktwerk simulate WORDS: hands on a machine that runs simulated: buttons, analog values, faults.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/machine/remote.hpp"
#include "apps/machine/sim_hands.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"

namespace taktwerk::apps {
namespace {

struct SimulateOptions {
    RemoteOptions remote;
    std::vector<std::string> words;
};

int help() {
    for (const auto& word : sim_words()) fmt::print("  {:<40} {}\n", fmt::format("{} {}", word.word, word.arguments), word.effect);
    return exit_ok;
}

int simulate(const SimulateOptions& options) {
    if (options.words.empty() || options.words.front() == "help") return help();
    const auto line = fmt::format("{}", fmt::join(options.words, " "));
    return with_machine(options.remote, [&](hmi::Client& client) {
        const auto answer = client.request({{"cmd", "simulate"}, {"line", line}});
        return answer ? report(options.remote, line) : report(options.remote, answer.error());
    });
}

}  // namespace

void add_simulate(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("simulate", "press buttons, set analog values and provoke faults on a machine that runs simulated");
    auto options = std::make_shared<SimulateOptions>();
    add_remote_options(*sub, options->remote);
    sub->add_option("WORDS", options->words, "e.g. `input start 1`, `after 2s drive-fault x 0x3130`, `unplug y_drive`; `help` lists them")
        ->expected(0, -1);
    sub->callback([&action, options] { action = [options] { return simulate(*options); }; });
}

}  // namespace taktwerk::apps
