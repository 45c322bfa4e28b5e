#pragma once
// The versions of each machine on this computer:
//
//   ROOT/bundles/MACHINE/versions/1.4.0/     manifest.json, manifest.sig, files/...
//   ROOT/bundles/MACHINE/activations/17/     active_bundle.hpp
//   ROOT/bundles/MACHINE/current             -> activations/17
//   ROOT/bundles/MACHINE/audit.log           audit.hpp
//   ROOT/state/MACHINE/                      what a machine keeps whichever version runs: its relative directories
//
// A version is put together aside and moved to its place by one rename, with everything on the disk before. Not real-time.

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "runtime/bundle/bundle_file.hpp"
#include "runtime/bundle/durable.hpp"
#include "runtime/bundle/target.hpp"
#include "runtime/bundle/trust.hpp"

namespace taktwerk::runtime {

class BundleStore {
public:
    explicit BundleStore(std::filesystem::path root) : root_(std::move(root)) {}

    struct Installed {
        UnpackedBundle bundle;
        Signer signer;
        enum class Was { there, new_here } was = Was::new_here;  ///< there: the same bundle had been installed before
    };
    /// Nothing of a bundle that is refused is left. Errors: those of BundleFile::open(), fits() and unpack(); bundle.other (another bundle of this name and
    /// version is installed), bundle.no_room, bundle.folder.
    [[nodiscard]] Result<Installed> install(const std::string& path, const Trust& trust, const Host& host) const;
    /// One that was opened already, as `path`.
    [[nodiscard]] Result<Installed> install(const BundleFile& bundle, const std::string& path, const Host& host) const;
    /// Errors: bundle.unknown (names those that are there), those of read_unpacked().
    [[nodiscard]] Result<UnpackedBundle> find(const std::string& machine, const std::string& version) const;
    /// Neither the active version nor the one to go back to. Errors: bundle.unknown, bundle.in_use, bundle.folder.
    [[nodiscard]] Result<void> remove(const std::string& machine, const std::string& version) const;

    /// Names, sorted; of folders that could hold something.
    [[nodiscard]] std::vector<std::string> machines() const;
    /// In the order of their numbers.
    [[nodiscard]] std::vector<std::string> versions(const std::string& machine) const;

    [[nodiscard]] const std::filesystem::path& root() const noexcept { return root_; }
    [[nodiscard]] std::filesystem::path bundles() const { return root_ / "bundles"; }
    [[nodiscard]] std::filesystem::path folder(const std::string& machine) const { return bundles() / machine; }
    [[nodiscard]] std::filesystem::path version_folder(const std::string& machine, const std::string& version) const {
        return folder(machine) / "versions" / version;
    }
    [[nodiscard]] std::filesystem::path state(const std::string& machine) const { return root_ / "state" / machine; }
    /// Keeps other commands out, and removes what killed ones have left. Errors: bundle.folder.
    [[nodiscard]] Result<OwnedFd> lock() const;

private:
    [[nodiscard]] Result<std::optional<UnpackedBundle>> same_there(const BundleFile& bundle, const std::string& path) const;
    std::filesystem::path root_;
};

}  // namespace taktwerk::runtime
