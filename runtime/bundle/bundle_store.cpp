#include "runtime/bundle/bundle_store.hpp"

#include <sys/statvfs.h>

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/nearest_name.hpp"
#include "runtime/bundle/active_bundle.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

/// What a file costs beyond its bytes: the rest of its last block, its entry.
constexpr std::uint64_t cost_of_a_file = 8192;

std::vector<std::string> names_in(const fs::path& folder, bool (*good)(std::string_view)) {
    std::vector<std::string> names;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
        if (auto name = entry->path().filename().string(); good(name) && entry->is_directory(failed) && !entry->is_symlink(failed))
            names.push_back(std::move(name));
    std::sort(names.begin(), names.end());
    return names;
}

Result<void> room_for(const BundleFile& bundle, const fs::path& folder) {
    struct statvfs info {};
    if (::statvfs(folder.c_str(), &info) != 0) return {};
    const auto needed = bundle.bytes() + cost_of_a_file * (bundle.manifest().files.size() + 8);
    const auto free = std::uint64_t{info.f_bavail} * info.f_frsize;
    if (free >= needed) return {};
    return Error{
        "bundle.no_room", folder.string(),
        fmt::format("it needs {:.1f} MB, and {:.1f} MB are free", static_cast<double>(needed) / 1e6, static_cast<double>(free) / 1e6),
        "make room on that disk: `taktwerk bundle list` and `taktwerk bundle remove`"};
}

}  // namespace

Result<OwnedFd> BundleStore::lock() const {
    if (auto ok = make_folders(bundles()); !ok) return ok.error();
    auto locked = lock_folder(bundles());
    if (locked) AsideFolder::sweep(bundles());
    return locked;
}

Result<std::optional<UnpackedBundle>> BundleStore::same_there(const BundleFile& bundle, const std::string& path) const {
    const auto& manifest = bundle.manifest();
    std::error_code failed;
    if (!fs::exists(version_folder(manifest.name, manifest.version), failed)) return std::optional<UnpackedBundle>{};
    auto there = read_unpacked(version_folder(manifest.name, manifest.version));
    if (!there) return there.error();
    if (there->manifest_text != bundle.manifest_text())
        return Error{"bundle.other", path,
                     fmt::format("another bundle is installed as '{}' {} already, made at {}", manifest.name, manifest.version,
                                 utc_text(there->manifest.created)),
                     "make it with another --version: what a version is never changes"};
    return std::optional(std::move(there).value());
}

Result<BundleStore::Installed> BundleStore::install(const std::string& path, const Trust& trust, const Host& host) const {
    const auto bundle = BundleFile::open(path, trust);
    if (!bundle) return bundle.error();
    return install(*bundle, path, host);
}

Result<BundleStore::Installed> BundleStore::install(const BundleFile& bundle, const std::string& path, const Host& host) const {
    const auto& manifest = bundle.manifest();
    if (auto ok = fits(manifest, host, path); !ok) return ok.error();
    std::optional<AsideFolder> aside;
    {
        const auto locked = lock();
        if (!locked) return locked.error();
        auto there = same_there(bundle, path);
        if (!there) return there.error();
        if (*there) return Installed{std::move(**there), bundle.signer(), Installed::Was::there};
        if (auto ok = room_for(bundle, bundles()); !ok) return ok.error();
        auto made = AsideFolder::make(bundles());
        if (!made) return made.error();
        aside.emplace(std::move(made).value());
    }
    // Long work, and nobody waits for it: nothing sees this folder yet.
    if (auto ok = bundle.unpack(aside->path()); !ok) return ok.error();
    const auto locked = lock();
    if (!locked) return locked.error();
    auto there = same_there(bundle, path);
    if (!there) return there.error();
    if (*there) return Installed{std::move(**there), bundle.signer(), Installed::Was::there};
    const auto place = version_folder(manifest.name, manifest.version);
    if (auto ok = make_folders(place.parent_path()); !ok) return ok.error();
    if (auto ok = move_into_place(aside->path(), place); !ok) return ok.error();
    auto now = read_unpacked(place);
    if (!now) return now.error();
    return Installed{std::move(now).value(), bundle.signer(), Installed::Was::new_here};
}

Result<UnpackedBundle> BundleStore::find(const std::string& machine, const std::string& version) const {
    const auto known_machines = machines();
    if (std::find(known_machines.begin(), known_machines.end(), machine) == known_machines.end()) {
        const auto near = nearest_name(machine, known_machines);
        return Error{"bundle.unknown", machine,
                     known_machines.empty() ? fmt::format("no bundle is installed in {}", root_.string())
                                            : fmt::format("no bundle of this machine is installed in {} (there is: {})", root_.string(),
                                                          fmt::join(known_machines, ", ")),
                     near.empty() ? "`taktwerk bundle install FILE` brings one; --root names another folder"
                                  : fmt::format("did you mean '{}'?", near)};
    }
    const auto known = versions(machine);
    if (std::find(known.begin(), known.end(), version) == known.end())
        return Error{"bundle.unknown", machine,
                     fmt::format("version '{}' of it is not installed (there is: {})", version, fmt::join(known, ", ")),
                     "`taktwerk bundle install FILE` brings it"};
    return read_unpacked(version_folder(machine, version));
}

Result<void> BundleStore::remove(const std::string& machine, const std::string& version) const {
    const auto locked = lock();
    if (!locked) return locked.error();
    // One whose manifest is torn may go as well.
    if (const auto bundle = find(machine, version); !bundle && bundle.error().code == "bundle.unknown") return bundle.error();
    const auto place = version_folder(machine, version);
    const auto refuse = [&](std::string what, std::string remedy) {
        return Error{"bundle.in_use", fmt::format("{} {}", machine, version), std::move(what), std::move(remedy)};
    };
    const auto chain = activations_of(*this, machine);
    if (!chain.empty() && chain.front().version == version) return refuse("it is the active version", "activate another one first");
    if (chain.size() > 1 && chain[1].version == version)
        return refuse(fmt::format("it is the version to go back to from {}", chain.front().version),
                      "activate another one in between, or leave it");
    if (in_use(place)) return refuse("a machine runs from it", "stop the machine first");
    auto aside = AsideFolder::make(bundles());
    if (!aside) return aside.error();
    // Away by one rename, then piece by piece: nobody sees half a version.
    if (auto ok = move_into_place(place, aside->path() / "gone"); !ok) return ok;
    return sync_folder(place.parent_path());
}

std::vector<std::string> BundleStore::machines() const {
    auto names = names_in(bundles(), is_bundle_name);
    std::erase_if(names, [&](const std::string& name) { return versions(name).empty(); });
    return names;
}

std::vector<std::string> BundleStore::versions(const std::string& machine) const {
    if (!is_bundle_name(machine)) return {};
    auto names = names_in(folder(machine) / "versions", is_bundle_version);
    std::stable_sort(names.begin(), names.end(), version_before);
    return names;
}

}  // namespace taktwerk::runtime
