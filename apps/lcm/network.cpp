#include "apps/lcm/network.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "hmi_bridge/lcm_types/our_types.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* usual_url = "udpm://239.255.76.67:7667?ttl=0";
constexpr long wanted_buffer = 2 << 20;  // LCM's own advice

/// More than the system grants would only make LCM print a warning.
long granted_buffer() {
    std::ifstream file("/proc/sys/net/core/rmem_max");
    long most = 0;
    return file >> most ? std::min(most, wanted_buffer) : 0;
}

}  // namespace

void add_network_options(CLI::App& sub, NetworkOptions& options) {
    sub.add_option("--url", options.url, "LCM URL; default: $LCM_DEFAULT_URL, else " + std::string(usual_url));
    sub.add_option("--types", options.types, "folder of further .lcm files, to read other people's messages");
}

Result<hmi::LcmUrl> url_of(const NetworkOptions& options) {
    const char* usual = std::getenv("LCM_DEFAULT_URL");
    const std::string text = !options.url.empty() ? options.url : usual != nullptr && *usual != '\0' ? usual : usual_url;
    auto url = hmi::parse_lcm_url(text);
    if (!url || url->provider != hmi::LcmUrl::Provider::udpm || text.find("recv_buf_size=") != std::string::npos) return url;
    if (const auto buffer = granted_buffer(); buffer > 0) url->text += fmt::format("&recv_buf_size={}", buffer);
    return url;
}

Result<std::unique_ptr<hmi::LcmBus>> open_network(const NetworkOptions& options) {
    const auto url = url_of(options);
    if (!url) return url.error();
    return hmi::LcmBus::open(*url);
}

Result<hmi::TypeCatalog> types_of(const NetworkOptions& options) {
    auto catalog = hmi::our_types();
    if (options.types.empty()) return catalog;
    std::error_code failed;
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(options.types, failed), end; !failed && entry != end; entry.increment(failed))
        if (entry->path().extension() == ".lcm") files.push_back(entry->path());
    if (failed || files.empty())
        return Error{"lcm.types", options.types, failed ? failed.message() : "there is no .lcm file in this folder",
                     "Give the folder of the types' files."};
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        std::ifstream in(file, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        if (auto ok = catalog.add(text, file.string()); !ok) return ok.error();
    }
    return catalog;
}

}  // namespace taktwerk::apps
