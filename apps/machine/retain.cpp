// taktwerk retain: what a machine keeps over a time without power, looked at and changed while it does not run.

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/machine/load.hpp"
#include "apps/machine/retain_json.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "apps/terminal/text_table.hpp"
#include "core/nearest_name.hpp"
#include "runtime/bundle/durable.hpp"
#include "runtime/retain/retain_store.hpp"
#include "runtime/retain/value_type.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using namespace runtime;

constexpr std::size_t largest_export = std::size_t{64} << 20;  ///< bytes

struct RetainOptions {
    std::string where, file;
    std::vector<std::string> names;
    bool json = false, cold = false, all = false;
};

/// The directory itself, or the one that a machine file names.
Result<fs::path> directory_of(const std::string& where) {
    std::error_code failed;
    const auto what = fs::status(where, failed);
    if (fs::is_directory(what)) return fs::path(where);
    if (failed && what.type() != fs::file_type::not_found)
        return Error{"retain.where", where, fmt::format("it cannot be looked at: {}", failed.message()),
                     "do it as a user who may, or with sudo"};
    if (!fs::exists(what))
        return Error{"retain.where", where, "there is no such directory or machine file",
                     "name the directory of `retain` (or of `run --retain`), or a machine file that has one"};
    auto read = read_machine_without_programs(where, false);
    if (auto* errors = std::get_if<std::vector<Error>>(&read)) return errors->front();
    const auto& directory = std::get<LoadedFile>(read).machine.retain.directory;
    if (directory.empty())
        return Error{"retain.where", where, "this machine keeps nothing: its file has no `retain`, or its bus is simulated",
                     "name the directory that `run --retain` was given"};
    return fs::path(directory);
}

int fail(const Error& error) {
    print_error(error);
    return exit_bad_file;
}

/// A store with what is in it.
struct Opened {
    std::unique_ptr<RetainStore> store;
    Kept kept;
};

/// `to_change`: nobody else may have it, and what is there must be whole. Root acts as the directory's owner from here on: what is made there is the
/// machine's, which could not open it otherwise.
Result<Opened> open(const std::string& where, bool to_change) {
    auto directory = directory_of(where);
    if (!directory) return directory.error();
    if (to_change)
        if (auto ok = act_as_owner(*directory); !ok) return ok.error();
    Opened out{std::make_unique<RetainStore>(*directory), {}};
    if (to_change)
        if (auto in_use = out.store->lock()) return *in_use;
    auto loaded = out.store->load();
    for (const auto& damage : loaded.damage) print_warning(damage);
    if (loaded.lost)
        return Error{"retain.lost", directory->string(), "nothing of it can be read",
                     "`taktwerk retain clear --all` removes it; `import` brings back what was exported"};
    out.kept = std::move(loaded.kept);
    return out;
}

void print_kept(const Kept& kept) {
    const auto colours = colours_of_output();
    if (kept.empty()) {
        fmt::print("nothing is kept\n");
        return;
    }
    TextTable table{{{"name", TextTable::Column::Side::left, 48}, {"kind"}, {"type"}, {"value", TextTable::Column::Side::left, 60}, {""}}};
    const auto aside = [](Unclaimed starts) {
        return starts == 0 ? std::string{} : fmt::format("kept aside: nobody's for {} start{}", starts, starts == 1 ? "" : "s");
    };
    for (const auto& value : kept.values)
        table.add({value.name,
                   std::string(word(value.kind)),
                   std::string(word(value.type)),
                   text_of(value.type, value.bits),
                   {aside(value.unclaimed), Tone::faint}});
    for (const auto& block : kept.blocks)
        table.add({block.name,
                   std::string(word(block.kind)),
                   block.type,
                   fmt::format("{} bytes", block.bytes.size()),
                   {aside(block.unclaimed), Tone::faint}});
    for (const auto& parameter : kept.parameters)
        table.add(
            {parameter.name,
             "parameter",
             "LREAL",
             fmt::format("{}", parameter.value),
             {parameter.unclaimed > 0 ? aside(parameter.unclaimed) : fmt::format("configured: {}", parameter.configured), Tone::faint}});
    for (const auto& axis : kept.axes)
        table.add({axis.name,
                   "position",
                   "axis",
                   fmt::format("{} counts, count 0 lies at {}", axis.position.counts, axis.position.shift),
                   {axis.position.at_rest ? "stood there" : "was moving", Tone::faint}});
    fmt::print("{}", table.text(colours));
}

int show(const RetainOptions& options) {
    const auto opened = open(options.where, false);
    if (!opened) return fail(opened.error());
    if (options.json) fmt::print("{}\n", json_of(opened->kept).dump());
    else print_kept(opened->kept);
    return exit_ok;
}

/// An earlier export, a pipe or nothing may be written over, and no machine file.
std::optional<Error> not_to_be_replaced(const std::string& file) {
    std::error_code failed;
    const auto what = fs::status(file, failed);
    if (!fs::exists(what) || fs::is_fifo(what) || fs::is_character_file(what)) return std::nullopt;
    const auto there =
        fs::is_regular_file(what) ? read_small_file(fs::canonical(file, failed), largest_export) : Result<std::string>(std::string{});
    if (there && (there->empty() ? fs::is_regular_file(what) : there->find("\"taktwerk_retain\"") != std::string::npos))
        return std::nullopt;
    return Error{"retain.export", file, "there is something else already", "take another name, or remove it first"};
}

int export_to(const RetainOptions& options) {
    const auto opened = open(options.where, false);
    if (!opened) return fail(opened.error());
    if (const auto other = not_to_be_replaced(options.file)) return fail(*other);
    const auto text = json_of(opened->kept).dump(2) + "\n";
    std::error_code failed;
    // Whole or not at all: who exports each night has the last one when the disk is full.
    if (const auto what = fs::status(options.file, failed); fs::exists(what) && !fs::is_regular_file(what)) {
        std::ofstream out(options.file, std::ios::binary);
        out << text;
        out.close();
        if (!out) return fail({"retain.export", options.file, fmt::format("it cannot be written: {}", std::strerror(errno)), "look at it"});
    } else {
        const auto target = fs::exists(what) ? fs::canonical(options.file, failed) : fs::path(options.file);
        if (auto ok = replace_file(target, text); !ok) return fail({"retain.export", options.file, ok.error().what, ok.error().remedy});
    }
    fmt::print("{} values, {} parameters, {} blocks written to {}\n", opened->kept.values.size(), opened->kept.parameters.size(),
               opened->kept.blocks.size(), options.file);
    return exit_ok;
}

/// Those of `from` take the place of those of their name.
template <class T>
void merge(std::vector<T>& into, const std::vector<T>& from) {
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < into.size(); ++i) places.emplace(into[i].name, i);
    for (const auto& one : from) {
        const auto found = places.find(one.name);
        if (found == places.end()) into.push_back(one);
        else into[found->second] = one;
    }
}

/// A file, or what comes through a pipe.
Result<std::string> text_of_export(const std::string& file) {
    std::error_code failed;
    const auto what = fs::status(file, failed);
    if (fs::is_fifo(what) || fs::is_character_file(what)) {
        std::ifstream in(file, std::ios::binary);
        std::string text(largest_export, '\0');
        in.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(in.gcount()));
        return text;
    }
    return read_small_file(fs::exists(what) ? fs::canonical(file, failed) : fs::path(file), largest_export);
}

int import_from(const RetainOptions& options) {
    const auto text = text_of_export(options.file);
    if (!text) return fail({"retain.import", options.file, text.error().what, "give what `taktwerk retain export` has written"});
    const auto read = kept_of_json(options.file, *text);
    if (!read) return fail(read.error());
    auto opened = open(options.where, true);
    if (!opened) return fail(opened.error());
    auto kept = opened->kept;
    // A block whose bytes do not come with its pins would overrule them at the next start.
    const auto of_block = [](const KeptValue& pin, const KeptBlock& block) {
        return pin.name.size() > block.name.size() && pin.name.starts_with(block.name) && pin.name[block.name.size()] == '.';
    };
    std::erase_if(kept.blocks, [&](const KeptBlock& block) {
        return std::any_of(read->values.begin(), read->values.end(), [&](const KeptValue& pin) { return of_block(pin, block); });
    });
    merge(kept.values, read->values);
    merge(kept.blocks, read->blocks);
    merge(kept.parameters, read->parameters);
    if (const auto saved = opened->store->save(std::move(kept)); !saved) return fail(saved.error());
    fmt::print("{} values, {} parameters, {} blocks imported; positions of axes are as they were\n", read->values.size(),
               read->parameters.size(), read->blocks.size());
    return exit_ok;
}

int clear(const RetainOptions& options) {
    if (options.names.empty() && !options.cold && !options.all)
        return fail({"retain.clear", options.where, "nothing is named that shall go", "name values, or give --cold or --all"});
    auto opened = open(options.where, true);
    if (!opened && !(options.all && opened.error().code == "retain.lost")) return fail(opened.error());
    Kept kept = opened ? opened->kept : Kept{};
    std::vector<std::string> known;
    for (const auto& value : kept.values) known.push_back(value.name);
    for (const auto& parameter : kept.parameters) known.push_back(parameter.name);
    for (const auto& block : kept.blocks) known.push_back(block.name);
    for (const auto& name : options.names) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            const auto near = nearest_name(name, known);
            return fail({"retain.clear", name, "nothing of that name is kept",
                         near.empty() ? "`taktwerk retain show` lists them" : fmt::format("did you mean '{}'?", near)});
        }
        const auto gone = [&](const auto& one) { return one.name == name; };
        const auto of_it = [&](const KeptValue& one) { return one.name == name || one.name.starts_with(name + "."); };
        const bool block = std::any_of(kept.blocks.begin(), kept.blocks.end(), gone);
        std::erase_if(kept.blocks, [&](const KeptBlock& one) { return one.name == name || name.starts_with(one.name + "."); });
        if (block) std::erase_if(kept.values, of_it);
        else std::erase_if(kept.values, gone);
        std::erase_if(kept.parameters, gone);
    }
    if (options.cold) {
        const auto gone = [](const auto& one) { return one.kind == RetainKind::retain; };
        std::erase_if(kept.values, gone);
        std::erase_if(kept.blocks, gone);
    }
    if (options.all) kept = {};
    if (!opened) {  // nothing of it can be read, and nothing of it is to stay
        const auto directory = directory_of(options.where);
        if (!directory) return fail(directory.error());
        RetainStore store(*directory);
        if (auto ok = act_as_owner(*directory); !ok) return fail(ok.error());
        if (auto in_use = store.lock()) return fail(*in_use);
        (void)store.load();
        if (const auto saved = store.save({}); !saved) return fail(saved.error());
        if (const auto saved = store.save({}); !saved) return fail(saved.error());
    } else if (const auto saved = opened->store->save(std::move(kept)); !saved) return fail(saved.error());
    fmt::print("done: the next start begins with first values where nothing is kept{}\n", options.all ? ", and axes are not homed" : "");
    return exit_ok;
}

}  // namespace

void add_retain(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("retain", "what a machine keeps over a time without power");
    sub->require_subcommand(1);
    auto options = std::make_shared<RetainOptions>();
    const auto add = [&](const char* name, const char* doc, int (*run)(const RetainOptions&)) {
        auto* command = sub->add_subcommand(name, doc);
        command->add_option("WHERE", options->where, "its directory, or a machine file with `retain`")->required();
        command->callback([&action, options, run] { action = [options, run] { return run(*options); }; });
        return command;
    };
    add("show", "list it; also while the machine runs", show)->add_flag("--json", options->json, "as JSON");
    add("export", "write it to a JSON file", export_to)->add_option("FILE", options->file, "to be written")->required();
    add("import", "take values, parameters and blocks from such a file; the machine does not run", import_from)
        ->add_option("FILE", options->file, "to be read")
        ->required();
    auto* gone = add("clear", "let values go; the machine does not run", clear);
    gone->add_option("NAME", options->names, "those of these names");
    gone->add_flag("--cold", options->cold, "all but what is persistent, parameters and positions");
    gone->add_flag("--all", options->all, "everything, positions too: the axes have to be homed");
}

}  // namespace taktwerk::apps
