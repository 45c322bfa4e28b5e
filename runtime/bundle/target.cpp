#include "runtime/bundle/target.hpp"

#include <fmt/format.h>

#include "programs/api/abi.hpp"

namespace taktwerk::runtime {

namespace {

#if defined(__x86_64__)
constexpr const char* own_target = "linux-x86_64";
#elif defined(__aarch64__)
constexpr const char* own_target = "linux-aarch64";
#else
#error "what is this computer called?"
#endif

}  // namespace

Host this_host() { return {own_target, sdk_version, abi_hash(), program_interface_version}; }

Result<void> fits(const Manifest& manifest, const Host& host, const std::string& subject) {
    if (!manifest.programs.empty() && manifest.target != host.target)
        return Error{"bundle.target", subject,
                     fmt::format("its programs are built for {}, and this computer is {}", manifest.target, host.target),
                     fmt::format("build the programs for {} and make the bundle again", host.target)};
    if (version_before(host.version, manifest.minimum_runtime))
        return Error{"bundle.older_runtime", subject,
                     fmt::format("it needs Taktwerk {} or later, and this is {}", manifest.minimum_runtime, host.version),
                     "update Taktwerk on this computer, or make the bundle with its version"};
    for (const auto& program : manifest.programs)
        if (program.abi != host.abi)
            return Error{
                "bundle.abi", subject,
                fmt::format(
                    "program '{}' was built with SDK {} (interface {}, ABI {:016x}), and this runtime is {} (interface {}, ABI {:016x})",
                    program.name, program.sdk, program.interface_version, program.abi, host.version, host.interface_version, host.abi),
                "build the programs with the SDK of this runtime and make the bundle again"};
    return {};
}

}  // namespace taktwerk::runtime
