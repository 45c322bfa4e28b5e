// taktwerk bundle: a machine as one file, and its versions on this computer.

#include <fmt/format.h>

#include "apps/bundle/commands.hpp"
#include "apps/machine/bundle_run.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"

namespace taktwerk::apps {

runtime::BundleStore BundlePlaces::store() const { return runtime::BundleStore(bundle_root(root)); }

void add_root_option(CLI::App& sub, BundlePlaces& places) {
    sub.add_option("--root", places.root, "where bundles are; default: $STATE_DIRECTORY, else /var/lib/taktwerk");
}

void add_keys_option(CLI::App& sub, BundlePlaces& places) {
    sub.add_option("--trusted-keys", places.keys, "folder of the public keys whose bundles are taken")->capture_default_str();
}

int fail_bundle(const Error& error) {
    print_error(error);
    return error.code == "bundle.machine_runs" ? exit_refused : exit_bad_file;
}

std::string size_text(std::uint64_t bytes) {
    const auto size = static_cast<double>(bytes);
    return size >= 1e6   ? fmt::format("{:.1f} MB", size / 1e6)
           : size >= 1e3 ? fmt::format("{:.1f} kB", size / 1e3)
                         : fmt::format("{} bytes", bytes);
}

void add_bundle(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("bundle", "a machine as one file: make, sign, install, activate, roll back");
    sub->require_subcommand(1);
    sub->footer(
        "From a laptop to the machine and back (docs/bundle.md):\n"
        "  taktwerk bundle make cell.yaml -o cell.twb --version 1.4.0\n"
        "  taktwerk bundle install cell.twb\n"
        "  taktwerk bundle activate cell 1.4.0\n"
        "  taktwerk run --bundle cell\n"
        "  taktwerk bundle rollback cell");
    add_bundle_make(*sub, action);
    add_bundle_store(*sub, action);
    add_bundle_show(*sub, action);
    add_bundle_diff(*sub, action);
    add_bundle_keygen(*sub, action);
}

}  // namespace taktwerk::apps
