#pragma once
// What this runtime can run, and whether a bundle is for it. Not real-time.

#include <string>
#include <string_view>

#include "runtime/bundle/manifest.hpp"

namespace taktwerk::runtime {

/// The computer that a bundle is for, or this one.
struct Host {
    std::string target;     ///< "linux-x86_64"
    std::string version;    ///< of the runtime
    std::uint64_t abi = 0;  ///< what its programs must have been built against
    std::uint64_t interface_version = 0;
};

/// This one.
[[nodiscard]] Host this_host();

/// Errors: bundle.target (another processor), bundle.older_runtime (this runtime is older than it needs), bundle.abi (its programs were built against
/// another SDK).
[[nodiscard]] Result<void> fits(const Manifest& manifest, const Host& host, const std::string& subject);

}  // namespace taktwerk::runtime
