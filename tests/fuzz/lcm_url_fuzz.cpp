// Any bytes as an LCM URL: an error with a sentence, or a provider of ours whose text says the same again.
#include <cstdlib>
#include <string_view>

#include "hmi_bridge/lcm/lcm_url.hpp"

using namespace taktwerk::hmi;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto url = parse_lcm_url({reinterpret_cast<const char*>(data), size});
    if (!url) {
        if (url.error().code != "hmi.lcm_url" || url.error().what.empty()) std::abort();
        return 0;
    }
    if (url->ttl < 0 || url->ttl > 255) std::abort();
    if (url->text.find('\0') != std::string::npos) std::abort();  // LCM takes it as a C string
    const auto again = parse_lcm_url(url->text);
    if (!again || again->provider != url->provider || again->group != url->group || again->port != url->port || again->ttl != url->ttl ||
        again->text != url->text)
        std::abort();
    return 0;
}
