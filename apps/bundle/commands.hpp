#pragma once
// The sub-commands of `taktwerk bundle`, and what they share.

#include <string>

#include <CLI/CLI.hpp>

#include "apps/taktwerk.hpp"
#include "core/result.hpp"
#include "runtime/bundle/bundle_store.hpp"
#include "runtime/bundle/trust.hpp"

namespace taktwerk::apps {

/// Where bundles are on this computer, and whose it takes.
struct BundlePlaces {
    std::string root, keys = runtime::usual_trust_folder;
    [[nodiscard]] runtime::BundleStore store() const;
    [[nodiscard]] Result<runtime::Trust> trust() const { return runtime::Trust::read(keys); }
};
void add_root_option(CLI::App& sub, BundlePlaces& places);
void add_keys_option(CLI::App& sub, BundlePlaces& places);

void add_bundle_make(CLI::App& bundle, Action& action);
void add_bundle_keygen(CLI::App& bundle, Action& action);
void add_bundle_store(CLI::App& bundle, Action& action);  ///< install, activate, rollback, list, remove
void add_bundle_show(CLI::App& bundle, Action& action);
void add_bundle_diff(CLI::App& bundle, Action& action);

/// Prints it; 3, or 5 where a running machine stands in the way.
int fail_bundle(const Error& error);
/// "1.2 MB", "12.3 kB"
[[nodiscard]] std::string size_text(std::uint64_t bytes);

}  // namespace taktwerk::apps
