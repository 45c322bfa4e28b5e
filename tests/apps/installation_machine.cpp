// What `cmake --install` puts on a machine: the command that runs by itself there, and what people and their editors need beside it.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/child.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Every file below `source` that ends so stands below `installed`, with the same bytes. How many there are.
int compared(const fs::path& source, const fs::path& installed, const std::string& ending = "") {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(source)) {
        if (!entry.is_regular_file() || (!ending.empty() && entry.path().extension() != ending)) continue;
        const auto there = installed / fs::relative(entry.path(), source);
        EXPECT_TRUE(fs::is_regular_file(there)) << there << " is missing";
        EXPECT_TRUE(bytes_of(entry.path()) == bytes_of(there)) << there;
        ++count;
    }
    return count;
}

TEST(Installation, HoldsTheCommandItsDataTheTypesTheSchemasAndTheDocumentation) {
    const fs::path source = TAKTWERK_SOURCE_DIR;
    const fs::path prefix = fs::temp_directory_path() / ("taktwerk-installed-" + std::to_string(::getpid()));
    Child install({TAKTWERK_CMAKE, "--install", TAKTWERK_BINARY_DIR, "--component", "runtime", "--prefix", prefix.string()});
    ASSERT_EQ(install.wait(120s), 0) << install.text();
    const auto share = prefix / "share" / "taktwerk", doc = prefix / "share" / "doc" / "taktwerk";

    EXPECT_GT(compared(source / "config/drives", share / "drives", ".yaml"), 0);
    EXPECT_GT(compared(source / "config/machines", share / "machines", ".yaml"), 0);
    EXPECT_GT(compared(source / "config/devices", share / "devices", ".yaml"), 100);
    EXPECT_EQ(compared(source / "config/schema", share / "schema", ".json"), 3) << "of a machine, a drive and a device";
    // With the SDK, and only there: two packages must not own one file.
    EXPECT_FALSE(fs::exists(share / "lcm"));
    Child sdk({TAKTWERK_CMAKE, "--install", TAKTWERK_BINARY_DIR, "--component", "sdk", "--prefix", prefix.string()});
    ASSERT_EQ(sdk.wait(120s), 0) << sdk.text();
    EXPECT_GE(compared(source / "hmi_bridge/lcm", share / "lcm", ".lcm"), 12) << "hmi_bridge/README.md names twelve types";
    EXPECT_GT(compared(source / "docs", doc / "docs"), 0);
    for (const char* page : {"README.md", "LICENSE", "hmi_bridge/README.md"})
        EXPECT_TRUE(bytes_of(source / page) == bytes_of(doc / page)) << page;

    // Drives and programs are found from where the command stands.
    Child check({(prefix / "bin" / "taktwerk").string(), "check", (share / "machines" / "demo.yaml").string()});
    EXPECT_EQ(check.wait(60s), exit_ok) << check.text();
    EXPECT_THAT(check.text(), HasSubstr("no problem found"));
    fs::remove_all(prefix);
}

}  // namespace
}  // namespace taktwerk::apps
