// A taktwerk whose file has capabilities (setcap): whoever may call it brings programs along, and they must not get what he has not.

#include <linux/capability.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/child.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

const std::string build = TAKTWERK_BINARY_DIR, tree = TAKTWERK_SOURCE_DIR;
constexpr const char* nobody = "65534";

class BorrowedRights : public ::testing::Test {
protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "it takes root to give a file capabilities";
        auto pattern = (fs::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        fs::permissions(folder, fs::perms::all);
        binary = folder / "taktwerk";
        program = folder / "telling.so";
        fs::copy_file(build + "/taktwerk", binary);
        fs::copy_file(build + "/tests/telling_program.so", program);
        ASSERT_EQ(::chown(program.c_str(), 65534, 65534), 0);
        // The control: here, files do give capabilities to whoever starts them.
        const auto probe = folder / "cat";
        fs::copy_file("/bin/cat", probe);
        const auto given = give(probe) && give(binary) ? nobody_runs({probe.string(), "/proc/self/status"}).second : std::string();
        if (given.find("CapEff:\t0000000000003000") == std::string::npos)
            GTEST_SKIP() << "this file system or container gives no file capabilities";
        std::ifstream minimal(tree + "/config/machines/minimal.yaml");
        std::stringstream text;
        text << minimal.rdbuf() << "hmi: { socket: '" << (folder / "socket").string()
             << "', lcm: { enabled: false } }\nprograms:\n  telling:\n    library: " << program.string() << "\n";
        fs::create_directories(folder / "machines");
        fs::create_directory_symlink(tree + "/config/drives", folder / "drives");
        machine = folder / "machines" / "machine.yaml";
        std::ofstream(machine) << text.str();
    }
    ~BorrowedRights() override {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
    /// setcap cap_net_raw,cap_net_admin+ep
    static bool give(const fs::path& file) {
        vfs_cap_data capabilities{};
        capabilities.magic_etc = VFS_CAP_REVISION_2 | VFS_CAP_FLAGS_EFFECTIVE;
        capabilities.data[0].permitted = (1u << CAP_NET_RAW) | (1u << CAP_NET_ADMIN);
        return ::setxattr(file.c_str(), "security.capability", &capabilities, sizeof capabilities, 0) == 0;
    }
    /// As a user without any rights.
    std::pair<int, std::string> nobody_runs(std::vector<std::string> arguments) const {
        std::vector<std::string> all{"setpriv",
                                     std::string("--reuid=") + nobody,
                                     std::string("--regid=") + nobody,
                                     "--clear-groups",
                                     "env",
                                     "TAKTWERK_TEST_TELL=" + (folder / "told").string()};
        all.insert(all.end(), arguments.begin(), arguments.end());
        Child child(all);
        const int code = child.wait(30s);
        return {code, child.text()};
    }
    std::pair<int, std::string> as_nobody(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), binary.string());
        return nobody_runs(std::move(arguments));
    }
    std::string told() const {
        std::ifstream in(folder / "told");
        std::stringstream text;
        text << in.rdbuf();
        return text.str();
    }

    fs::path folder, binary, program, machine;
};

TEST_F(BorrowedRights, CheckLoadsAProgramWithTheRightsOfItsCaller) {
    const auto [code, text] = as_nobody({"check", machine.string()});
    EXPECT_EQ(code, exit_ok) << text;
    EXPECT_EQ(told(), "CapPrm:\t0000000000000000\nCapEff:\t0000000000000000\n");
}

TEST_F(BorrowedRights, RunLoadsNoProgramThatOthersThanRootMayWrite) {
    const auto [code, text] = as_nobody({"run", machine.string(), "--virtual-time", "--duration", "1s"});
    EXPECT_EQ(code, exit_bad_file) << text;
    EXPECT_THAT(text, HasSubstr("rights from its own file"));
    EXPECT_THAT(text, HasSubstr("service"));
    EXPECT_EQ(told(), "") << "not a line of it ran";
}

TEST_F(BorrowedRights, WithoutThemTheSameProgramRuns) {
    ASSERT_EQ(::removexattr(binary.c_str(), "security.capability"), 0);
    const auto [code, text] = as_nobody({"run", machine.string(), "--virtual-time", "--duration", "1s"});
    EXPECT_EQ(code, exit_ok) << text;
    EXPECT_THAT(told(), HasSubstr("CapEff:\t0000000000000000"));
}

}  // namespace
}  // namespace taktwerk::apps
