#include "apps/taktwerk.hpp"

#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/nearest_name.hpp"
#include "programs/api/abi.hpp"

namespace taktwerk::apps {

namespace {

/// What CLI11 would only call "A subcommand is required", or answer with the general help: a word that is no command, and an option of a
/// command in front of it.
std::optional<Error> misplaced(const CLI::App& app, int argc, char** argv) {
    const CLI::App* at = &app;
    std::string path = "taktwerk";
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if ((word == "-s" || word == "--socket") && i == 1)
            return Error{"usage.order", word, "this option belongs to a command, behind it", "write `taktwerk COMMAND -s NAME`"};
        if (word.empty() || word.front() == '-') return std::nullopt;
        std::vector<std::string> names;
        const CLI::App* next = nullptr;
        for (const auto* sub : at->get_subcommands([](const CLI::App*) { return true; })) {
            names.push_back(sub->get_name());
            if (sub->check_name(word)) next = sub;
        }
        if (names.empty()) return std::nullopt;  // the word is an argument
        if (next == nullptr) {
            const auto near = nearest_name(word, names);
            return Error{"usage.unknown_command", word, fmt::format("there is no command `{} {}`", path, word),
                         near.empty() ? fmt::format("`{} --help` lists them", path) : fmt::format("did you mean `{} {}`?", path, near)};
        }
        path += " " + word;
        at = next;
    }
    return std::nullopt;
}

}  // namespace

int run(int argc, char** argv) {
    // `taktwerk help jog` is `taktwerk jog --help`.
    static char help[] = "--help";
    std::vector<char*> words(argv, argv + argc);
    if (argc > 1 && std::string_view(argv[1]) == "help") {
        words.erase(words.begin() + 1);
        words.push_back(help);
        argv = words.data();
    }
    CLI::App app{"Taktwerk: soft-PLC and motion runtime"};
    app.set_version_flag("--version", std::string("taktwerk ") + sdk_version);
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 ok, 1 fit with warnings (doctor), 2 usage, 3 bad file, 4 bus, 5 refused by the machine, 6 no running machine, 7 no "
        "real time, 8 ended with an "
        "alarm, 9 could not end, 10 a replay differs");
    Action action;
    add_run(app, action);
    add_record(app, action);
    add_replay(app, action);
    add_check(app, action);
    add_status(app, action);
    add_monitor(app, action);
    add_hmi(app, action);
    add_lcm(app, action);
    add_operate(app, action);
    add_measure(app, action);
    add_alarms(app, action);
    add_retain(app, action);
    add_bundle(app, action);
    add_bus(app, action);
    add_drive(app, action);
    add_plot(app, action);
    add_gcode(app, action);
    add_sim(app, action);
    add_simulate(app, action);
    add_esi(app, action);
    add_doctor(app, action);
    add_diag(app, action);
    add_docs(app, action);
    if (const auto wrong = misplaced(app, argc, argv)) {
        print_error(*wrong);
        return exit_usage;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        return code == 0 ? exit_ok : exit_usage;
    }
    return action ? action() : exit_usage;
}

}  // namespace taktwerk::apps
