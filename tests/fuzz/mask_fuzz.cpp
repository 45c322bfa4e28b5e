// Any bytes as a text that leaves the house: lines stay lines, what was masked stays masked, and no neighbour makes a secret visible.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "apps/diag/mask.hpp"

using namespace taktwerk::apps;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string secret = "Zx9Hidden7";
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (text.find(secret) != std::string::npos) return 0;
    const auto clean = masked("password: " + secret + "\n" + text + "\npassword: " + secret + "\n");
    if (clean.text.find(secret) != std::string::npos) std::abort();
    if (clean.where.size() < 2) std::abort();
    if (std::count(clean.text.begin(), clean.text.end(), '\n') != std::count(text.begin(), text.end(), '\n') + 3) std::abort();
    return 0;
}
