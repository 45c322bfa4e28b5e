// `taktwerk retain`: what is kept, listed, carried away and back, and let go, as a person types it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/terminal/exit_code.hpp"
#include "runtime/retain/retain_store.hpp"
#include "tests/apps/in_process.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using namespace runtime;
using fb::PinKind;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct RetainCommand : ::testing::Test {
    RetainCommand() {
        auto name = (fs::temp_directory_path() / "taktwerk_retain_XXXXXX").string();
        folder = mkdtemp(name.data());
        Kept kept;
        kept.values = {{"cell.pieces", RetainKind::retain, PinKind::LINT, (std::uint64_t{1} << 53) + 1, 0},  // no double holds it
                       {"cell.total", RetainKind::persistent, PinKind::LREAL, std::bit_cast<std::uint64_t>(0.1), 0},
                       {"cell.old", RetainKind::retain, PinKind::BOOL, 1, 3},
                       {"cell.count.CV", RetainKind::retain, PinKind::INT, 7, 0}};
        kept.blocks = {{"cell.count", RetainKind::retain, "CTU", 0x1234, {std::byte{1}, std::byte{2}}, 0}};
        kept.parameters = {{"cell.speed", 180, 200, 0}};
        kept.axes = {{"x",
                      {.homed = true, .shift = 12.5, .counts = -4711, .at_rest = true},
                      axes::Gearing{.counts_per_revolution = 131072, .feed = 10}}};
        RetainStore store(where());
        EXPECT_TRUE(store.save(kept));
    }
    ~RetainCommand() override { fs::remove_all(folder); }
    [[nodiscard]] fs::path where() const { return folder / "kept"; }
    [[nodiscard]] Kept kept() const { return RetainStore(where()).load().kept; }
    Outcome retain(std::vector<std::string> words) const {
        words.insert(words.begin(), "retain");
        return in_process(std::move(words));
    }
    fs::path folder;
};

TEST_F(RetainCommand, ShowsNamesTypesValuesAndWhatNobodyHas) {
    const auto shown = retain({"show", where()});
    EXPECT_EQ(shown.code, exit_ok);
    EXPECT_THAT(shown.out, AllOf(HasSubstr("9007199254740993"), HasSubstr("persistent"), HasSubstr("nobody's for 3 starts"),
                                 HasSubstr("configured: 200"), HasSubstr("-4711 counts")));
    const auto json = retain({"show", where(), "--json"}).json();
    EXPECT_EQ(json["values"][0]["value"], "9007199254740993") << "text: no reader rounds it";
    EXPECT_EQ(json["axes"][0]["name"], "x");
}

TEST_F(RetainCommand, WhatIsExportedComesBackButForPositions) {
    const auto file = (folder / "kept.json").string();
    ASSERT_EQ(retain({"export", where(), file}).code, exit_ok);
    const auto before = kept();
    ASSERT_EQ(retain({"clear", where(), "--all"}).code, exit_ok);
    EXPECT_TRUE(kept().empty());
    const auto imported = retain({"import", where(), file});
    ASSERT_EQ(imported.code, exit_ok) << imported.err;
    const auto after = kept();
    EXPECT_EQ(after.blocks, before.blocks);
    EXPECT_EQ(after.parameters, before.parameters);
    ASSERT_EQ(after.values.size(), before.values.size());
    for (std::size_t i = 0; i < after.values.size(); ++i) EXPECT_EQ(after.values[i].bits, before.values[i].bits);
    EXPECT_TRUE(after.axes.empty()) << "a position belongs to one encoder";
}

TEST_F(RetainCommand, APinThatIsImportedWithoutItsBlockIsNotOverruledByIt) {
    const auto file = folder / "one.json";
    std::ofstream(file) << R"({"taktwerk_retain":1,"values":[{"name":"cell.count.CV","kind":"retain","type":"INT","value":"50"}]})";
    ASSERT_EQ(retain({"import", where(), file}).code, exit_ok);
    EXPECT_TRUE(kept().blocks.empty());
    EXPECT_EQ(kept().values.size(), 4u) << "the others stay";
    EXPECT_EQ(kept().axes.size(), 1u);
}

TEST_F(RetainCommand, LetsGoByNameOrKind) {
    EXPECT_EQ(retain({"clear", where(), "cell.pieces"}).code, exit_ok);
    EXPECT_EQ(kept().values.size(), 3u);
    EXPECT_EQ(retain({"clear", where(), "cell.count"}).code, exit_ok);
    EXPECT_TRUE(kept().blocks.empty());
    EXPECT_EQ(kept().values.size(), 2u) << "its pins go with it";
    EXPECT_EQ(retain({"clear", where(), "--cold"}).code, exit_ok);
    ASSERT_EQ(kept().values.size(), 1u);
    EXPECT_EQ(kept().values[0].name, "cell.total");
    EXPECT_EQ(kept().axes.size(), 1u);
    const auto misspelt = retain({"clear", where(), "cell.totl"});
    EXPECT_EQ(misspelt.code, exit_bad_file);
    EXPECT_THAT(misspelt.err, HasSubstr("did you mean 'cell.total'?"));
    EXPECT_THAT(retain({"clear", where()}).err, HasSubstr("--cold or --all"));
}

TEST_F(RetainCommand, WhatChangesSomethingWantsTheMachineStopped) {
    RetainStore running(where());
    ASSERT_FALSE(running.lock());
    EXPECT_EQ(retain({"show", where()}).code, exit_ok);
    for (const auto& words : {std::vector<std::string>{"clear", where(), "--cold"}, {"import", where(), "/dev/null"}}) {
        const auto refused = retain(words);
        EXPECT_EQ(refused.code, exit_bad_file);
        EXPECT_THAT(refused.err, ::testing::AnyOf(HasSubstr(std::to_string(::getpid())), HasSubstr("not JSON")));
    }
    EXPECT_EQ(kept().values.size(), 4u);
}

TEST_F(RetainCommand, WrongFilesAreToldWithTheirPlaceAndChangeNothing) {
    const std::pair<const char*, const char*> files[] = {
        {"nonsense", "not JSON"},
        {"[]", "none of these exports"},
        {R"({"taktwerk_retain":2})", "this version reads 1"},
        {R"({"taktwerk_retain":1,"values":5})", "no list"},
        {R"({"taktwerk_retain":1,"values":[{"name":"a.b","kind":"retain","type":"USINT","value":"300"}]})", "values[0] 'a.b'"},
        {R"({"taktwerk_retain":1,"values":[{"name":"a.b","kind":"for ever","type":"USINT","value":"3"}]})", "\"kind\""},
        {R"({"taktwerk_retain":1,"values":[{"kind":"retain","type":"USINT","value":"3"}]})", "\"name\""},
        {R"({"taktwerk_retain":1,"parameters":[{"name":"a.b","value":"3","configured":1}]})", "\"value\" is no number"},
        {R"({"taktwerk_retain":1,"blocks":[{"name":"a.b","kind":"retain","type":"CTU","layout":"12","bytes":"0x"}]})", "bytes"},
        {R"({"taktwerk_retain":1,"values":[{"name":"a.b","kind":"retain","type":"INT","value":"3"},{"name":"a.b","kind":"retain","type":"INT","value":"4"}]})",
         "twice"},
    };
    for (const auto& [text, says] : files) {
        const auto file = folder / "wrong.json";
        std::ofstream(file) << text;
        const auto refused = retain({"import", where(), file});
        EXPECT_EQ(refused.code, exit_bad_file) << text;
        EXPECT_THAT(refused.err, HasSubstr(says)) << text;
    }
    EXPECT_EQ(kept().values.size(), 4u);
    EXPECT_THAT(retain({"show", folder / "nothing"}).err, HasSubstr("no such directory or machine file"));
}

TEST_F(RetainCommand, HowLongItHasBeenNobodysTravelsAsWell) {
    const auto file = folder / "kept.json";
    ASSERT_EQ(retain({"export", where(), file}).code, exit_ok);
    ASSERT_EQ(retain({"import", folder / "other", file}).code, exit_bad_file) << "there is no such directory";
    fs::create_directory(folder / "other");
    ASSERT_EQ(retain({"import", folder / "other", file}).code, exit_ok);
    ASSERT_EQ(retain({"export", folder / "other", folder / "again.json"}).code, exit_ok);
    auto before = retain({"show", where(), "--json"}).json(), after = retain({"show", folder / "other", "--json"}).json();
    for (auto* one : {&before, &after}) one->erase("axes"), one->erase("number");
    EXPECT_EQ(before, after);
}

// The file is lines of words: what a text could make of that.
TEST_F(RetainCommand, NoTextOfAnImportBecomesAnotherEntry) {
    const std::string axis = R"(A 0 0 00\naxis y homed 1 shift 12.5 counts -4711 at_rest 1 gearing 131072 1 1 10 0\nblock b retain B)";
    const std::string value = R"(A 0 0 00\nvalue cell.pieces retain LINT 1 0\nblock b retain B)";
    for (const auto& type : {axis, value, std::string("A B"), std::string()}) {
        const auto file = folder / "wrong.json";
        std::ofstream(file) << R"({"taktwerk_retain":1,"blocks":[{"name":"a.b","kind":"retain","type":")" << type
                            << R"(","layout":"12","bytes":"00"}]})";
        const auto refused = retain({"import", where(), file});
        EXPECT_EQ(refused.code, exit_bad_file) << type;
        EXPECT_THAT(refused.err, HasSubstr("\"type\" is no name")) << type;
    }
    EXPECT_EQ(kept().axes.size(), 1u) << "positions are never imported";
    EXPECT_EQ(kept().values.size(), 4u);
}

TEST_F(RetainCommand, WhatCouldNotBeReadAgainIsNotImported) {
    std::string values;
    for (int i = 0; i < 16384; ++i)
        values += (i > 0 ? "," : "") + (R"({"name":"many.v)" + std::to_string(i) + R"(","kind":"retain","type":"BOOL","value":"1"})");
    const auto file = folder / "many.json";
    std::ofstream(file) << R"({"taktwerk_retain":1,"values":[)" << values << "]}";
    const auto refused = retain({"import", where(), file});
    EXPECT_EQ(refused.code, exit_bad_file) << "those that are there already are too many beside them";
    EXPECT_THAT(refused.err, HasSubstr("could not be read again"));
    EXPECT_EQ(kept().values.size(), 4u);
    std::ofstream(file) << R"({"taktwerk_retain":1,"values":[)" << values
                        << R"(,{"name":"a.b","kind":"retain","type":"BOOL","value":"1"}]})";
    EXPECT_THAT(retain({"import", where(), file}).err, HasSubstr("16385 entries"));
}

TEST_F(RetainCommand, ArgumentsInTheWrongOrderAreSaid) {
    const auto file = (folder / "kept.json").string();
    ASSERT_EQ(retain({"export", where(), file}).code, exit_ok);
    const auto turned = retain({"import", file, where()});
    EXPECT_EQ(turned.code, exit_bad_file);
    EXPECT_THAT(turned.err, HasSubstr("it is no file"));
    EXPECT_EQ(retain({"import", where(), folder}).code, exit_bad_file);
    fs::create_symlink("loop", folder / "loop");
    EXPECT_THAT(retain({"show", folder / "loop"}).err, HasSubstr("cannot be looked at"));
}

TEST_F(RetainCommand, AnExportReplacesAnEarlierOneAndNothingElse) {
    const auto file = folder / "kept.json";
    ASSERT_EQ(retain({"export", where(), file}).code, exit_ok);
    EXPECT_EQ(retain({"export", where(), file}).code, exit_ok);
    std::ofstream(folder / "cell.yaml") << "version: 1\n";
    const auto refused = retain({"export", where(), folder / "cell.yaml"});
    EXPECT_EQ(refused.code, exit_bad_file);
    EXPECT_THAT(refused.err, HasSubstr("there is something else already"));
    EXPECT_EQ(fs::file_size(folder / "cell.yaml"), 11u);
    EXPECT_EQ(retain({"export", where(), folder}).code, exit_bad_file);
    EXPECT_EQ(retain({"export", where(), "/dev/null"}).code, exit_ok) << "as ever";
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(RetainCommand, RootLeavesNothingThatTheMachineCannotOpen) {
    if (::geteuid() != 0) GTEST_SKIP() << "needs root";
    const auto file = (folder / "kept.json").string();
    ASSERT_EQ(retain({"export", where(), file}).code, exit_ok);
    fs::permissions(folder, fs::perms::others_exec | fs::perms::others_read, fs::perm_options::add);
    for (const auto& entry : fs::directory_iterator(where())) fs::remove(entry);
    ASSERT_EQ(::chown(where().c_str(), 65534, 65534), 0);
    std::vector<std::string> words{"taktwerk", "retain", "import", where(), file};
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    std::fflush(stdout);
    const auto child = ::fork();  // who works as the owner does so for good
    if (child == 0) ::_exit(run(static_cast<int>(argv.size()), argv.data()));
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(where())) {
        struct stat info {};
        ASSERT_EQ(::lstat(entry.path().c_str(), &info), 0);
        EXPECT_EQ(info.st_uid, 65534u) << entry.path();
        ++files;
    }
    EXPECT_EQ(files, 2u) << "what is kept, and the lock";
}

TEST_F(RetainCommand, WhatCannotBeReadIsSaidAndMayBeClearedAway) {
    for (const auto* slot : {"retain.0", "retain.1"}) std::ofstream(where() / slot, std::ios::app) << "x";
    EXPECT_THAT(retain({"show", where()}).err, HasSubstr("torn or altered"));
    EXPECT_EQ(retain({"clear", where(), "--all"}).code, exit_ok);
    EXPECT_THAT(retain({"show", where()}).out, HasSubstr("nothing is kept"));
}

}  // namespace
}  // namespace taktwerk::apps
