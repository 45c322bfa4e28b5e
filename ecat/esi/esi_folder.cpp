#include "ecat/esi/esi_folder.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <tuple>

namespace taktwerk::ecat::esi {

namespace {

namespace fs = std::filesystem;

bool is_xml(const fs::path& path) {
    auto ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".xml";
}

}  // namespace

Result<EsiFolder> EsiFolder::open(const std::string& path) {
    std::error_code problem;
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(path, problem), end; !problem && entry != end; entry.increment(problem))
        if (is_xml(entry->path())) files.push_back(entry->path());
    if (problem)
        return Error{"esi.folder", path, "the folder cannot be read: " + problem.message(), "give the folder with the vendors' XML files"};
    std::sort(files.begin(), files.end());
    EsiFolder out;
    out.path_ = path;
    for (const auto& one : files) {
        const auto file = EsiFile::open(one.string());
        if (!file) {
            if (file.error().code != "esi.not_esi") out.damaged_.push_back(file.error());
            continue;
        }
        for (const auto& heading : file->devices())
            if (heading.identity.product != 0) out.devices_.push_back({one.filename().string(), file->vendor_name(), heading});
    }
    if (out.devices_.empty())
        return Error{"esi.folder", path, "no ESI file in it describes a device", "give the folder with the vendors' XML files"};
    return out;
}

const EsiKnown* EsiFolder::find(const Identity& identity) const noexcept {
    constexpr std::uint32_t variant = 0xFFFF;
    const EsiKnown* best = nullptr;
    const auto rank = [&](const EsiKnown& known) {
        const auto revision = known.heading.identity.revision;
        const bool same_variant = (revision & variant) == (identity.revision & variant);
        return std::tuple(revision == identity.revision, same_variant && revision <= identity.revision, same_variant, revision);
    };
    for (const auto& known : devices_) {
        const auto& id = known.heading.identity;
        if (id.vendor != identity.vendor || id.product != identity.product) continue;
        if (best == nullptr || rank(*best) < rank(known)) best = &known;
    }
    return best;
}

}  // namespace taktwerk::ecat::esi
