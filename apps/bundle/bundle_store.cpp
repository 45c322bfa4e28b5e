// taktwerk bundle install, activate, rollback, list, remove: the versions of the machines of this computer.

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/bundle/commands.hpp"
#include "apps/bundle/idle_machine.hpp"
#include "apps/machine/bundle_run.hpp"
#include "apps/machine/load.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "apps/terminal/text_table.hpp"
#include "runtime/bundle/active_bundle.hpp"

namespace taktwerk::apps {
namespace {

using namespace runtime;
using Json = nlohmann::ordered_json;

struct StoreOptions {
    BundlePlaces places;
    std::string file, machine, version;
    bool json = false;
};

void say_open_door(const Trust& trust, const BundlePlaces& places) {
    if (!trust.keys().empty()) return;
    print_warning({"trust.nobody", places.keys, "no key is trusted on this computer, so it takes every bundle, whoever made it",
                   "put the .pub of who may bring bundles there: `taktwerk bundle keygen`"});
}

/// Of the active version; where its file does not load, the machine is asked by its name.
std::string socket_of(const BundleStore& store, const std::string& machine, const std::string& version) {
    const auto bundle = store.find(machine, version);
    if (!bundle) return {};
    auto read = read_machine_without_programs(bundle->machine_file().string(), false);
    const auto* loaded = std::get_if<LoadedFile>(&read);
    return loaded != nullptr ? loaded->hmi.socket : std::string{};
}

Result<Runs> idle(const BundleStore& store, const std::string& machine) {
    const auto chain = activations_of(store, machine);
    if (chain.empty()) return idle_machine(machine, {}, {});
    const auto& version = chain.front().version;
    return idle_machine(machine, socket_of(store, machine, version), store.version_folder(machine, version));
}

int install(const StoreOptions& options) {
    const auto trust = options.places.trust();
    if (!trust) return fail_bundle(trust.error());
    const auto store = options.places.store();
    const auto bundle = BundleFile::open(options.file, *trust);  // wherever it is: with the rights of whoever asked
    if (!bundle) return fail_bundle(bundle.error());
    if (const auto ok = act_as_owner(store.root()); !ok) return fail_bundle(ok.error());
    const auto installed = store.install(*bundle, options.file, this_host());
    if (!installed) return fail_bundle(installed.error());
    const auto& manifest = installed->bundle.manifest;
    say_open_door(*trust, options.places);
    fmt::print("{} {} {} ({})\n", manifest.name, manifest.version,
               installed->was == BundleStore::Installed::Was::there ? "was installed already" : "is installed",
               words_of(installed->signer));
    const auto chain = activations_of(store, manifest.name);
    if (chain.empty() || chain.front().version != manifest.version)
        fmt::print("{}. To start with it: taktwerk bundle activate {} {}\n",
                   chain.empty() ? "No version of it is active" : fmt::format("{} is active as before", chain.front().version),
                   manifest.name, manifest.version);
    return exit_ok;
}

int tell(const std::string& machine, const Switched& switched, Runs runs) {
    for (const auto& remark : switched.remarks) print_warning(remark);
    fmt::print("{}: {} is active{}\n", machine, switched.to, switched.from.empty() ? "" : fmt::format(", {} was", switched.from));
    if (runs == Runs::without_power)
        fmt::print("The machine runs and goes on with what it has. Stop it and start it: `taktwerk shutdown`, then\n");
    fmt::print("{}: taktwerk run --bundle {}\n", runs == Runs::without_power ? "it starts with" : "It starts with", machine);
    if (!switched.next_back.empty()) fmt::print("Back to {}: taktwerk bundle rollback {}\n", switched.next_back, machine);
    return exit_ok;
}

int activate_version(const StoreOptions& options) {
    const auto trust = options.places.trust();
    if (!trust) return fail_bundle(trust.error());
    const auto store = options.places.store();
    if (const auto known = store.find(options.machine, options.version); !known) return fail_bundle(known.error());
    const auto runs = idle(store, options.machine);
    if (!runs) return fail_bundle(runs.error());
    const auto deed = deed_now();
    if (const auto ok = act_as_owner(store.root()); !ok) return fail_bundle(ok.error());
    const auto switched = activate(store, options.machine, options.version, *trust, this_host(), deed);
    if (!switched) return fail_bundle(switched.error());
    say_open_door(*trust, options.places);
    return tell(options.machine, *switched, *runs);
}

int rollback(const StoreOptions& options) {
    const auto store = options.places.store();
    const auto runs = idle(store, options.machine);
    if (!runs) return fail_bundle(runs.error());
    const auto deed = deed_now();
    if (const auto ok = act_as_owner(store.root()); !ok) return fail_bundle(ok.error());
    const auto switched = roll_back(store, options.machine, this_host(), deed);
    if (!switched) return fail_bundle(switched.error());
    return tell(options.machine, *switched, *runs);
}

int remove_version(const StoreOptions& options) {
    const auto store = options.places.store();
    if (const auto ok = act_as_owner(store.root()); !ok) return fail_bundle(ok.error());
    if (const auto removed = store.remove(options.machine, options.version); !removed) return fail_bundle(removed.error());
    fmt::print("{} {} is gone\n", options.machine, options.version);
    return exit_ok;
}

/// What a version is on this computer, in words.
std::string standing(const std::vector<Activation>& chain, const std::string& version) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
        if (chain[i].version != version) continue;
        const auto& one = chain[i];
        const auto health = one.worked              ? std::string("has worked")
                            : one.failed_starts > 0 ? fmt::format("{} start{} failed", one.failed_starts, one.failed_starts == 1 ? "" : "s")
                                                    : std::string("not started yet");
        return fmt::format("{}{}", i == 0 ? "active, " : i == 1 ? "rollback goes here, " : "", health);
    }
    return "installed";
}

int list(const StoreOptions& options) {
    const auto store = options.places.store();
    TextTable table{{{"machine"}, {"version"}, {"made"}, {"state"}}};
    auto all = Json::array();
    for (const auto& machine : store.machines()) {
        const auto chain = activations_of(store, machine);
        for (const auto& version : store.versions(machine)) {
            const auto bundle = store.find(machine, version);
            const auto state = bundle ? standing(chain, version) : "damaged: " + bundle.error().what;
            const bool active = !chain.empty() && chain.front().version == version;
            const auto made = bundle ? utc_text(bundle->manifest.created) : std::string{};
            table.add({machine, version, made, {state, active ? Tone::good : bundle ? Tone::plain : Tone::bad}});
            all.push_back(Json{{"machine", machine}, {"version", version}, {"made", made}, {"active", active}, {"state", state}});
        }
    }
    if (options.json) fmt::print("{}\n", all.dump(2, ' ', false, Json::error_handler_t::replace));
    else if (table.empty()) fmt::print("no bundle is installed in {}\n", store.bundles().string());
    else fmt::print("{}", table.text(colours_of_output()));
    return exit_ok;
}

}  // namespace

void add_bundle_store(CLI::App& bundle, Action& action) {
    auto options = std::make_shared<StoreOptions>();
    const auto add = [&](const char* name, const char* doc, int (*run)(const StoreOptions&)) {
        auto* command = bundle.add_subcommand(name, doc);
        add_root_option(*command, options->places);
        command->callback([&action, options, run] { action = [options, run] { return run(*options); }; });
        return command;
    };
    const auto machine = [&](CLI::App* command) { command->add_option("MACHINE", options->machine, "its name")->required(); };
    const auto version = [&](CLI::App* command) {
        command->add_option("VERSION", options->version, "one of `taktwerk bundle list`")->required();
    };
    auto* bring = add("install", "bring a bundle to this computer; the active version stays the active one", install);
    bring->add_option("FILE", options->file, "the bundle")->required();
    add_keys_option(*bring, options->places);
    auto* choose = add("activate", "the version that the machine starts with; no axis may be enabled", activate_version);
    machine(choose), version(choose);
    add_keys_option(*choose, options->places);
    machine(add("rollback", "back to the version that was active before; no axis may be enabled", rollback));
    add("list", "what is installed, and what is active", list)->add_flag("--json", options->json, "as JSON");
    auto* away = add("remove", "let an installed version go", remove_version);
    machine(away), version(away);
}

}  // namespace taktwerk::apps
