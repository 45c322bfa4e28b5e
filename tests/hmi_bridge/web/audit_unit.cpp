// What pages have commanded, in a file that only grows: rotation, a disk that takes nothing, a line torn in the middle.

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hmi_bridge/web/audit_line.hpp"
#include "hmi_bridge/web/audit_log.hpp"

namespace taktwerk::hmi::web {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Audit : public ::testing::Test {
protected:
    Audit() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-audit-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~Audit() override { fs::remove_all(folder_); }
    [[nodiscard]] std::string path(const std::string& ending = "") const { return (folder_ / "audit.jsonl").string() + ending; }
    [[nodiscard]] static std::vector<std::string> lines(const std::string& file) {
        std::ifstream in(file);
        std::vector<std::string> all;
        for (std::string line; std::getline(in, line);) all.push_back(line);
        return all;
    }

    fs::path folder_;
};

TEST_F(Audit, IsAppendedToWhatIsThereAndReadByItsGroup) {
    ASSERT_TRUE(AuditFile::open(path())->append("one"));
    ASSERT_TRUE(AuditFile::open(path())->append("two"));
    EXPECT_THAT(lines(path()), ElementsAre("one", "two"));
    struct stat state {};
    ASSERT_EQ(::stat(path().c_str(), &state), 0);
    EXPECT_EQ(state.st_mode & 0137, 0u) << "at most 0640";
    EXPECT_FALSE(AuditFile::open("/proc/none/audit"));
    fs::create_symlink(path(), path(".link"));
    EXPECT_FALSE(AuditFile::open(path(".link"))) << "a link is somebody else's idea of where it goes";
}

TEST_F(Audit, NineOldOnesAreKept) {
    auto file = AuditFile::open(path(), 10);
    for (int i = 0; i < 14; ++i) ASSERT_TRUE(file->append("line " + std::to_string(100 + i)));
    EXPECT_THAT(lines(path()), ElementsAre("line 113"));
    EXPECT_THAT(lines(path(".1")), ElementsAre("line 112"));
    EXPECT_THAT(lines(path(".9")), ElementsAre("line 104"));
    EXPECT_FALSE(fs::exists(path(".10")));
}

TEST_F(Audit, ADiskThatTakesNothingIsToldOnceAndWhatIsMissingIsCounted) {
    std::vector<std::string> said;
    {
        auto full = AuditFile::open("/dev/full");
        AuditLog log(std::move(*full), [&](const Error& error) { said.push_back(error.text()); });
        for (int i = 0; i < 5; ++i) log.put("lost");
    }
    ASSERT_EQ(said.size(), 1u);
    EXPECT_THAT(said[0], HasSubstr("No space left"));
}

// A limit on the file's size tears the third line, as a full disk does: the fourth begins on a line of its own.
TEST_F(Audit, ALineThatWasTornDoesNotSwallowTheNext) {
    auto file = AuditFile::open(path());
    const std::string line(40, 'a');
    ASSERT_TRUE(file->append(line));
    ASSERT_TRUE(file->append(line));
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{100, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    EXPECT_FALSE(file->append(line));
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    ASSERT_TRUE(file->append("whole"));
    EXPECT_THAT(lines(path()), ElementsAre(line, line, line.substr(0, 18), "whole"));
}

// What a stranger calls himself is shown by terminals: nothing of it may be more than text.
TEST(AuditLine, MovesNoCursorAndTurnsNoText) {
    using namespace std::string_literals;
    const std::pair<std::string, std::string> cases[]{
        {"anna", "anna"},
        {"\xE5\xBC\xA0\xC3\xA4\xF0\x9F\x98\x80", "\xE5\xBC\xA0\xC3\xA4\xF0\x9F\x98\x80"},
        {"a\nb", R"(a\nb)"},
        {"\x1b[2J", R"(\u001b[2J)"},
        {"\xC2\x9B"
         "2J",
         R"(\u009b2J)"},
        {"\x7f", R"(\u007f)"},
        {"a\xE2\x80\xA8"
         "b",
         R"(a\u2028b)"},
        {"\xE2\x80\xAE"
         "evil",
         R"(\u202eevil)"},
        {"\xE2\x81\xA6", R"(\u2066)"},
        {"\xEF\xBB\xBF", R"(\ufeff)"},
        {"\0"s, R"(\u0000)"},
    };
    for (const auto& [name, shown] : cases) {
        const auto text = audit_text({{"user", name}});
        EXPECT_EQ(text, R"({"user":")" + shown + "\"}");
        EXPECT_EQ(nlohmann::ordered_json::parse(text)["user"], name) << "nothing is lost";
    }
    EXPECT_NO_THROW((void)audit_text({{"user", "\xff"}}));
}

TEST(AuditLine, OfALongRequestTheBeginningStands) {
    const nlohmann::ordered_json small{{"cmd", "home"}, {"axis", "x"}}, large{{"cmd", "home"}, {"axis", std::string(60'000, 'A')}};
    EXPECT_EQ(bounded(small), small);
    EXPECT_LT(bounded(large).dump().size(), longest_in_audit);
    EXPECT_THAT(bounded(large)["begins"].get<std::string>(), HasSubstr(R"({"cmd":"home")"));
    EXPECT_EQ(bounded(large)["bytes"], large.dump().size());
}

// Forty at once, then one each two seconds (audit_line.hpp); everything else is counted for whom it was.
TEST(AuditLine, RefusalsAreBoundedForEachAndCounted) {
    using namespace std::chrono_literals;
    RefusalBudget budget;
    std::size_t written = 0;
    for (int i = 0; i < 1000; ++i) written += budget.take("user olga", Instant{1s}) ? 1 : 0;
    EXPECT_EQ(written, 40u);
    EXPECT_TRUE(budget.take("user emil", Instant{1s})) << "somebody else's are his own";
    EXPECT_FALSE(budget.next_unwritten(Instant{10s})) << "not yet due";
    const auto more = budget.next_unwritten(Instant{11s});
    ASSERT_TRUE(more);
    EXPECT_EQ(more->who, "user olga");
    EXPECT_EQ(more->times, 960u);
    EXPECT_FALSE(budget.next_unwritten(Instant{11s}));
    written = 0;
    for (int second = 11; second < 71; ++second) written += budget.take("user olga", Instant{std::chrono::seconds(second)}) ? 1 : 0;
    EXPECT_GE(written, 30u);
    EXPECT_LE(written, 36u);
    EXPECT_EQ(budget.next_unwritten(Instant{71s}, true)->times, 60u - written);
}

}  // namespace
}  // namespace taktwerk::hmi::web
