#include "ecat/esi/choose_device.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/nearest_name.hpp"
#include "ecat/esi/esi_number.hpp"

namespace taktwerk::ecat::esi {

namespace {

bool same_word(const std::string& a, const std::string& b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// The types of a file for a message, each once.
std::string types_text(const std::vector<EsiHeading>& devices) {
    constexpr std::size_t most = 8;
    std::vector<std::string> types;
    for (const auto& device : devices)
        if (std::find(types.begin(), types.end(), device.type) == types.end()) types.push_back(device.type);
    const auto shown = std::min(types.size(), most);
    std::string text = fmt::format("{}", fmt::join(types.begin(), types.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
    if (types.size() > most) text += fmt::format(" and {} others", types.size() - most);
    return text;
}

}  // namespace

Result<std::size_t> choose_device(const EsiFile& file, const std::string& word, std::optional<std::uint32_t> revision) {
    const auto& devices = file.devices();
    if (devices.empty())
        return Error{"esi.no_device", file.name(), "there is no device in this file", "give the file that describes the device itself"};
    const auto number = parse_number(word);
    const bool is_type =
        std::any_of(devices.begin(), devices.end(), [&](const EsiHeading& device) { return same_word(device.type, word); });
    if (number && !is_type) {
        if (*number >= 1 && *number <= static_cast<std::int64_t>(devices.size())) return static_cast<std::size_t>(*number - 1);
        return Error{"esi.no_device", file.name(), fmt::format("there is no device {} in it: it has {}", word, devices.size()),
                     fmt::format("choose one of {}", types_text(devices))};
    }
    std::vector<std::size_t> matching;
    std::set<std::string> types;
    for (std::size_t n = 0; n < devices.size(); ++n)
        if (word.empty() || same_word(devices[n].type, word)) {
            matching.push_back(n);
            types.insert(devices[n].type);
        }
    if (matching.empty()) {
        std::vector<std::string> names;
        for (const auto& device : devices) names.push_back(device.type);
        const auto near = nearest_name(word, names);
        return Error{"esi.no_device", file.name(), fmt::format("there is no device '{}' in it", word),
                     near.empty() ? fmt::format("choose one of {}", types_text(devices)) : fmt::format("did you mean {}?", near)};
    }
    if (types.size() > 1)
        return Error{"esi.which_device", file.name(), fmt::format("it holds {} types of device", types.size()),
                     fmt::format("choose one with --device: {}", types_text(devices))};
    if (revision) {
        const auto found =
            std::find_if(matching.begin(), matching.end(), [&](std::size_t n) { return devices[n].identity.revision == *revision; });
        if (found != matching.end()) return *found;
        std::vector<std::string> known;
        for (const auto n : matching) known.push_back(fmt::format("{:08X}h", devices[n].identity.revision));
        return Error{"esi.no_device", file.name(),
                     fmt::format("{} has no revision {:08X}h in it", devices[matching.front()].type, *revision),
                     fmt::format("choose one of {}", fmt::join(known, ", "))};
    }
    return *std::max_element(matching.begin(), matching.end(), [&](std::size_t a, std::size_t b) {
        return std::pair{!devices[a].hidden, devices[a].identity.revision} < std::pair{!devices[b].hidden, devices[b].identity.revision};
    });
}

}  // namespace taktwerk::ecat::esi
