// What the compiler has to read for one file: the heaviest compilations of the tree stay below a bound in lines. Lines and no seconds, so that a
// busy machine says the same. A header that drags a library of templates into everything is seen here first.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace taktwerk {
namespace {

/// All that the files of one compilation have, headers that are precompiled apart: lines, and what comes of it.
struct Compilation {
    long lines = 0;
    std::string object;
};

long lines_of(const std::string& path, std::map<std::string, long>& known) {
    const auto found = known.find(path);
    if (found != known.end()) return found->second;
    std::ifstream file{path, std::ios::binary};
    const auto lines = file ? std::count(std::istreambuf_iterator<char>{file}, std::istreambuf_iterator<char>{}, '\n') : 0;
    return known[path] = static_cast<long>(lines);
}

/// As Ninja noted them when it built: `object: #deps N, ...` and then a file a line.
std::vector<Compilation> compilations() {
    const std::string folder = TAKTWERK_BINARY_DIR;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe{popen(("ninja -C " + folder + " -t deps 2>/dev/null").c_str(), "r"), pclose};
    std::vector<Compilation> all;
    std::map<std::string, long> known;
    std::array<char, 4096> part{};
    while (pipe && std::fgets(part.data(), static_cast<int>(part.size()), pipe.get())) {
        std::string line = part.data();
        while (!line.empty() && line.back() == '\n') line.pop_back();
        const auto name_ends = line.find(": #deps");
        if (name_ends != std::string::npos) {
            all.push_back({0, line.substr(0, name_ends)});
        } else if (line.size() > 4 && line[0] == ' ' && !all.empty()) {
            const auto path = line.substr(line.find_first_not_of(' '));
            if (path.ends_with(".gch") || path.ends_with(".pch")) continue;
            all.back().lines += lines_of(path[0] == '/' ? path : folder + '/' + path, known);
        }
    }
    return all;
}

TEST(UnitsOfCompilation, TheHeaviestStayBelowTheirBound) {
    auto all = compilations();
    if (all.empty()) GTEST_SKIP() << "not built by Ninja: what a file includes is not known";
#ifdef __clang__
    GTEST_SKIP() << "the bound is of builds by g++, whose headers are precompiled and not counted with each unit";
#endif
    // Boost's HTTP and WebSocket are parsed in one place, and again by nobody (hmi_bridge/web/server/web_server.hpp).
    std::erase_if(all, [](const auto& unit) { return unit.object.ends_with("web/server/web_server.cpp.o"); });
    // What a part's tests have in common is read once for all of them, with GoogleMock: a bound of its own.
    std::erase_if(all, [](const auto& unit) {
        constexpr long bound_of_common_headers = 300'000;  // 280,000 when it was set, those of blocks
        const bool common = unit.object.ends_with(".gch");
        if (common) {
            EXPECT_LE(unit.lines, bound_of_common_headers) << unit.object;
        }
        return common;
    });
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.lines > b.lines; });
    all.resize(std::min<std::size_t>(all.size(), 10));
    for (const auto& unit : all) std::printf("%8ld lines: %s\n", unit.lines, unit.object.c_str());
    EXPECT_GT(all.front().lines, 10'000);  // else nothing was read
    constexpr long bound = 240'000;        // 208,000 when it was set; 232,000 since groups are part of the state
    for (const auto& unit : all) EXPECT_LE(unit.lines, bound) << unit.object;
}

}  // namespace
}  // namespace taktwerk
