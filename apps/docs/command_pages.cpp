#include "apps/docs/command_pages.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace taktwerk::apps {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// As man(7) wants a text: a backslash is none of its own, a hyphen is one that can be searched and copied, a dot that begins a line is no macro.
std::string roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\') out += "\\e";
        else if (c == '-') out += "\\-";
        else if (c == '\n') out += "\n.br\n";
        else out += c;
    }
    if (!out.empty() && (out.front() == '.' || out.front() == '\'')) out.insert(0, "\\&");
    return out;
}

/// In quotes, as an argument of a macro.
std::string argument(const std::string& text) {
    auto out = roff(text);
    for (std::size_t at = 0; (at = out.find('"', at)) != std::string::npos; at += 2) out.replace(at, 1, "\"\"");
    return '"' + out + '"';
}

std::string capitals(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

/// "FILE", "--duration", "-s, --socket": as a person types it.
std::string names(const CLI::Option& option) {
    if (option.get_positional()) return option.get_single_name();
    std::vector<std::string> all;
    for (const auto& name : option.get_snames()) all.push_back("-" + name);
    for (const auto& name : option.get_lnames()) all.push_back("--" + name);
    return fmt::format("{}", fmt::join(all, ", "));
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

void put_options(std::string& page, const CLI::App& app, bool positional) {
    for (const auto* option : app.get_options([&](const CLI::Option* o) { return o->get_positional() == positional; })) {
        if (option->get_group().empty()) continue;  // hidden
        const bool value = !positional && takes_value(*option);
        page += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(names(*option)), value ? " \\fI" + roff(option->get_type_name()) + "\\fR" : "",
                            roff(option->get_description()));
    }
}

std::string usage(const CLI::App& app, const std::string& path) {
    std::string line = fmt::format(".B {}\n", roff(path));
    const auto options = app.get_options([](const CLI::Option* o) { return !o->get_positional() && !o->get_group().empty(); });
    if (!options.empty()) line += "[\\fIoptions\\fR]\n";
    for (const auto* option : app.get_options([](const CLI::Option* o) { return o->get_positional(); })) {
        const auto name = roff(names(*option));
        line += option->get_required() ? fmt::format("\\fI{}\\fR\n", name) : fmt::format("[\\fI{}\\fR]\n", name);
    }
    if (!commands_of(app).empty()) line += "\\fIcommand\\fR ...\n";
    return line;
}

void put_command(std::string& page, const CLI::App& app, const std::string& path) {
    page += fmt::format(".SS {}\n{}\n.PP\n{}", argument(path), roff(app.get_description()), usage(app, path));
    put_options(page, app, true);
    put_options(page, app, false);
    for (const auto* sub : commands_of(app)) put_command(page, *sub, path + " " + sub->get_name());
}

std::string head(const std::string& name, const std::string& version) {
    return fmt::format(".TH {} 1 \"\" {} \"Taktwerk\"\n", argument(capitals(name)), argument("taktwerk " + version));
}

std::string page_of(const CLI::App& app, const std::string& version) {
    const auto name = "taktwerk-" + app.get_name();
    const auto path = "taktwerk " + app.get_name();
    auto page = head(name, version) +
                fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}", roff(name), roff(app.get_description()), usage(app, path));
    page += ".SH OPTIONS\n";
    put_options(page, app, true);
    put_options(page, app, false);
    if (const auto subs = commands_of(app); !subs.empty()) {
        page += ".SH COMMANDS\n";
        for (const auto* sub : subs) put_command(page, *sub, path + " " + sub->get_name());
    }
    return page + ".SH SEE ALSO\n.BR taktwerk (1)\n";
}

std::string front_page(const CLI::App& root, const std::string& version) {
    auto page = head("taktwerk", version) + ".SH NAME\ntaktwerk \\- soft\\-PLC and motion runtime\n.SH SYNOPSIS\n" +
                usage(root, "taktwerk") +
                ".SH DESCRIPTION\nRuns machines that are described in a YAML file: EtherCAT drives, PLCopen blocks, programs in C++; and "
                "talks to machines that run.\n"
                ".SH COMMANDS\n";
    std::vector<std::string> others;
    for (const auto* sub : commands_of(root)) {
        page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(sub->get_name()), roff(sub->get_description()));
        others.push_back(fmt::format(".BR {} (1)", roff("taktwerk-" + sub->get_name())));
    }
    page += ".SH OPTIONS\n";
    put_options(page, root, false);
    page += fmt::format(".SH EXIT STATUS\n{}\n", roff(root.get_footer()));
    page +=
        ".SH FILES\n.TP\n\\fI/etc/taktwerk/\\fR\nmachine files of the service taktwerk@\n"
        ".TP\n\\fI/usr/share/taktwerk/\\fR\ndrives, devices, examples of machines, JSON schemas, LCM types\n"
        ".TP\n\\fI/usr/share/doc/taktwerk/docs/\\fR\nthe documentation\n";
    return page + fmt::format(".SH SEE ALSO\n{}\n", fmt::join(others, ",\n"));
}

/// In single quotes for a shell.
std::string quoted(const std::vector<std::string>& words) {
    auto text = fmt::format("{}", fmt::join(words, " "));
    std::erase(text, '\'');
    return "'" + text + "'";
}

/// The list of an option that takes one of a few words: CLI11 says it as "TEXT:{a,b}".
std::vector<std::string> choices(const CLI::Option& option) {
    const auto text = option.get_type_name();
    const auto begin = text.find('{'), end = text.find('}');
    std::vector<std::string> all;
    if (begin == std::string::npos || end == std::string::npos || end < begin) return all;
    std::string word;
    for (const char c : text.substr(begin + 1, end - begin - 1) + ",") {
        if (c == ',') {
            if (!word.empty()) all.push_back(word);
            word.clear();
        } else if (c != ' ') word += c;
    }
    return all;
}

void collect(const CLI::App& app, const std::string& path, std::string& known, std::string& words, std::string& values) {
    std::vector<std::string> all;
    for (const auto* sub : commands_of(app)) all.push_back(sub->get_name());
    for (const auto* option : app.get_options()) {
        if (option->get_group().empty()) continue;
        if (option->get_positional()) {
            for (auto& choice : choices(*option)) all.push_back(choice);
            continue;
        }
        for (const auto& name : option->get_lnames()) all.push_back("--" + name);
        for (const auto& name : option->get_snames()) all.push_back("-" + name);
        if (const auto list = choices(*option); !list.empty())
            for (const auto& name : option->get_lnames())
                values += fmt::format("        '{} --{}') words={};;\n", path, name, quoted(list));
    }
    words += fmt::format("        '{}') words={};;\n", path, quoted(all));
    for (const auto* sub : commands_of(app)) {
        known += fmt::format("            '{} {}') ;;\n", path, sub->get_name());
        collect(*sub, path + " " + sub->get_name(), known, words, values);
    }
}

/// The generated parts go in where their names stand.
constexpr const char* script = R"BASH(# bash completion of taktwerk(1): made by `taktwerk docs completion`
_taktwerk() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} path='' words='' i
    for ((i = 1; i < COMP_CWORD; i++)); do
        case "$path ${COMP_WORDS[i]}" in
@KNOWN@            *) continue ;;
        esac
        path="$path ${COMP_WORDS[i]}"
    done
    case "$before" in
        -s|--socket)
            for i in /run/taktwerk/*.sock "${XDG_RUNTIME_DIR:-/nonexistent}"/taktwerk/*.sock "/tmp/taktwerk-$UID"/*.sock; do
                [[ ! -S $i ]] || words+=" $(basename "$i" .sock)"
            done ;;
    esac
    case "$path $before" in
@VALUES@        *) ;;
    esac
    if [[ -z $words ]]; then
        case "$path" in
@WORDS@        esac
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    [[ ${#COMPREPLY[@]} -gt 0 || $word == -* ]] || mapfile -t COMPREPLY < <(compgen -f -- "$word")
}
complete -o filenames -F _taktwerk taktwerk
)BASH";

void put_in(std::string& text, std::string_view name, const std::string& part) { text.replace(text.find(name), name.size(), part); }

}  // namespace

std::vector<std::pair<std::string, std::string>> man_pages(const CLI::App& root, const std::string& version) {
    std::vector<std::pair<std::string, std::string>> pages{{"taktwerk.1", front_page(root, version)}};
    for (const auto* sub : commands_of(root)) pages.emplace_back("taktwerk-" + sub->get_name() + ".1", page_of(*sub, version));
    return pages;
}

std::string bash_completion(const CLI::App& root) {
    std::string known, words, values;
    collect(root, "", known, words, values);
    std::string text = script;
    put_in(text, "@KNOWN@", known);
    put_in(text, "@VALUES@", values);
    put_in(text, "@WORDS@", words);
    return text;
}

}  // namespace taktwerk::apps
