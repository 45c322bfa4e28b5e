// `taktwerk bundle` as a person types it: what is packed, what is said, what is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include <sys/stat.h>

#include "apps/terminal/exit_code.hpp"
#include "runtime/bundle/durable.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/runtime/bundle/small_bundle.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using runtime::TemporaryFolder;
using runtime::text_of_file;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// One axis on a simulated drive, no program, a cam table from a folder beside and an image of a view.
std::string machine_text(const std::string& velocity = "300 mm/s") {
    return "version: 1\nname: press\ncycle: 1 ms\nbus:\n  interface: simulated\n  slaves:\n    - { name: x_drive, profile: own_drive }\n"
           "axes:\n  x:\n    slave: x_drive\n    unit: mm\n    gearing: { counts_per_revolution: 131072, feed: 10 mm }\n"
           "    limits: { velocity: " +
           velocity +
           ", acceleration: 2000 mm/s2, jerk: 50000 mm/s3 }\n    following_error: { window: 5 mm }\n    homing: { kind: set_here }\n"
           "  m: { unit: mm, gearing: { counts_per_revolution: 1000, feed: 10 mm }, limits: { velocity: 100 mm/s, acceleration: 100 mm/s2, "
           "jerk: none } }\n"
           "cams:\n  cut: { master: m, slave: x, file: ../tables/cut.csv }\n"
           "views:\n  main:\n    title: Press\n    rows:\n      - - { image: plan.svg }\n";
}

struct BundleCommand : ::testing::Test {
    TemporaryFolder folder;
    BundleCommand() {
        for (const char* name : {"cell", "tables", "drives", "keys"}) fs::create_directory(folder.path() / name);
        write_machine();
        folder.write("tables/cut.csv", "master [mm], slave [mm]\n0, 0\n10, 5\n20, 0\n");
        fs::copy_file(source / "config/machines/demo-cell.svg", folder.path() / "cell/plan.svg");
        // A drive file of its own, with the two that it takes its objects and alarms from.
        fs::copy_file(source / "config/drives/sv33-e.yaml", folder.path() / "drives/own_drive.yaml");
        for (const char* name : {"sv33-e.objects.yaml", "sv33-e.alarms.yaml"})
            fs::copy_file(source / "config/drives" / name, folder.path() / "drives" / name);
    }
    void write_machine(const std::string& velocity = "300 mm/s") const { folder.write("cell/press.yaml", machine_text(velocity)); }
    [[nodiscard]] std::string path(const std::string& name) const { return (folder.path() / name).string(); }
    static Outcome bundle(std::vector<std::string> words) {
        words.insert(words.begin(), "bundle");
        return in_process(std::move(words));
    }
    /// With this test's own folders.
    Outcome on_host(std::vector<std::string> words, bool keys = false) const {
        words.insert(words.end(), {"--root", path("root")});
        if (keys) words.insert(words.end(), {"--trusted-keys", path("keys")});
        return bundle(std::move(words));
    }
    Outcome make(const std::string& version, std::vector<std::string> more = {}) const {
        std::vector<std::string> words{"make", path("cell/press.yaml"), "--version", version, "-o", path(version + ".twb")};
        words.insert(words.end(), more.begin(), more.end());
        return bundle(std::move(words));
    }
};

TEST_F(BundleCommand, MakePacksWhatTheFileNames) {
    const auto made = make("1.0");
    ASSERT_EQ(made.code, exit_ok) << made.err;
    EXPECT_THAT(made.out, AllOf(HasSubstr("machine 'press' 1.0 for linux-"), HasSubstr("machine/press.yaml"), HasSubstr("tables/cut.csv"),
                                HasSubstr("machine/plan.svg"), HasSubstr("drives/own_drive.yaml"), HasSubstr("drives/sv33-e.objects.yaml"),
                                HasSubstr("drives/sv33-e.alarms.yaml"), HasSubstr("Not signed")));
    const auto shown = bundle({"show", path("1.0.twb"), "--json"});
    ASSERT_EQ(shown.code, exit_ok);
    EXPECT_EQ(shown.json()["machine_file"], "machine/press.yaml");
}

TEST_F(BundleCommand, WhatCheckRefusesIsNotPacked) {
    write_machine("300 m");
    const auto made = make("1.0");
    EXPECT_EQ(made.code, exit_bad_file);
    const auto checked = in_process({"check", path("cell/press.yaml")});
    EXPECT_EQ(made.err, checked.err) << "in the words of check";
    EXPECT_THAT(made.err, HasSubstr("press.yaml:13:25: `300 m` for `axes.x.limits.velocity`"));
    EXPECT_FALSE(fs::exists(path("1.0.twb")));
}

TEST_F(BundleCommand, OtherReadersOfTarReadIt) {
    ASSERT_EQ(make("1.0").code, exit_ok);
    fs::create_directory(path("out"));
    ASSERT_EQ(std::system(("tar -xf " + path("1.0.twb") + " -C " + path("out")).c_str()), 0);
    EXPECT_EQ(text_of_file(path("out/files/machine/press.yaml")), machine_text());
    EXPECT_EQ(text_of_file(path("out/files/tables/cut.csv")), text_of_file(path("tables/cut.csv")));
    EXPECT_EQ(bundle({"show", path("1.0.twb"), "--json"}).out, text_of_file(path("out/manifest.json")));
}

TEST_F(BundleCommand, TheSameFilesMakeTheSameBundleWhereTheTimeIsGiven) {
    ::setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
    ASSERT_EQ(make("1.0").code, exit_ok);
    const auto first = text_of_file(path("1.0.twb"));
    ASSERT_EQ(make("1.0").code, exit_ok);
    ::unsetenv("SOURCE_DATE_EPOCH");
    EXPECT_EQ(text_of_file(path("1.0.twb")), first);
    EXPECT_THAT(first, HasSubstr("2023-11-14T22:13:20Z"));
}

TEST_F(BundleCommand, FromInstallToRollback) {
    ASSERT_EQ(make("1.0").code, exit_ok);
    write_machine("250 mm/s");
    ASSERT_EQ(make("1.1").code, exit_ok);
    const auto installed = on_host({"install", path("1.0.twb")}, true);
    ASSERT_EQ(installed.code, exit_ok) << installed.err;
    EXPECT_THAT(installed.out, AllOf(HasSubstr("press 1.0 is installed (not signed)"), HasSubstr("taktwerk bundle activate press 1.0")));
    EXPECT_THAT(installed.err, HasSubstr("no key is trusted on this computer"));
    ASSERT_EQ(on_host({"activate", "press", "1.0"}, true).code, exit_ok);
    ASSERT_EQ(on_host({"install", path("1.1.twb")}, true).code, exit_ok);
    const auto difference = on_host({"diff", "press", "press@1.1"});
    EXPECT_EQ(difference.code, exit_ok) << difference.err;
    EXPECT_THAT(difference.out, AllOf(HasSubstr("changed machine/press.yaml"), HasSubstr("axes.x.limits.velocity: 300 mm/s -> 250 mm/s"),
                                      Not(HasSubstr("changed drives"))));
    const auto activated = on_host({"activate", "press", "1.1"}, true);
    EXPECT_THAT(activated.out, AllOf(HasSubstr("press: 1.1 is active, 1.0 was"), HasSubstr("taktwerk run --bundle press"),
                                     HasSubstr("Back to 1.0: taktwerk bundle rollback press")));
    auto list = on_host({"list", "--json"}).json();
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[1]["version"], "1.1");
    EXPECT_EQ(list[1]["active"], true);
    EXPECT_THAT(on_host({"rollback", "press"}).out, HasSubstr("press: 1.0 is active, 1.1 was"));
    EXPECT_EQ(on_host({"list", "--json"}).json()[0]["active"], true);
    EXPECT_THAT(on_host({"rollback", "press"}).err, HasSubstr("no other version was active before 1.0"));
    EXPECT_EQ(on_host({"remove", "press", "1.1"}).code, exit_ok);
    EXPECT_THAT(on_host({"remove", "press", "1.0"}).err, HasSubstr("it is the active version"));
}

TEST_F(BundleCommand, OnceAKeyIsTrustedOnlyWhatItSignedIsTaken) {
    ASSERT_EQ(bundle({"keygen", "plant", "-o", path("")}).code, exit_ok);
    ASSERT_EQ(bundle({"keygen", "other", "-o", path("")}).code, exit_ok);
    struct stat info {};
    ASSERT_EQ(::stat(path("plant.key").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0600u) << "nobody else reads it";
    ASSERT_EQ(make("1.0").code, exit_ok);
    ASSERT_EQ(make("1.1", {"--key", path("plant.key")}).code, exit_ok);
    ASSERT_EQ(make("1.2", {"--key", path("other.key")}).code, exit_ok);
    fs::copy_file(path("plant.pub"), path("keys/plant.pub"));

    const auto refused = on_host({"install", path("1.0.twb")}, true);
    EXPECT_EQ(refused.code, exit_bad_file);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("nobody has signed it"), HasSubstr("plant (")));
    EXPECT_THAT(on_host({"install", path("1.2.twb")}, true).err, HasSubstr("none of the trusted keys has signed"));
    const auto taken = on_host({"install", path("1.1.twb")}, true);
    EXPECT_EQ(taken.code, exit_ok) << taken.err;
    EXPECT_THAT(taken.out, HasSubstr("signed by plant ("));
    EXPECT_EQ(taken.err, "");
    EXPECT_THAT(on_host({"show", "press@1.1"}, true).out, HasSubstr("signed by plant ("));
    EXPECT_THAT(on_host({"show", path("1.2.twb")}, true).out, HasSubstr("signed by nobody who is trusted here"));
}

TEST_F(BundleCommand, KeysAndSignaturesAreThoseOfOpenssl) {
    if (std::system("openssl version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no openssl here";
    ASSERT_EQ(std::system(("openssl genpkey -algorithm ed25519 -out " + path("theirs.key") + " 2> /dev/null").c_str()), 0);
    ASSERT_EQ(std::system(("openssl pkey -in " + path("theirs.key") + " -pubout -out " + path("keys/theirs.pub")).c_str()), 0);
    ASSERT_EQ(make("1.0", {"--key", path("theirs.key")}).code, exit_ok);
    EXPECT_THAT(on_host({"install", path("1.0.twb")}, true).out, HasSubstr("signed by theirs ("));
    const auto part = [&](const char* name) { return "tar -xOf " + path("1.0.twb") + " " + name + " > " + path(name); };
    ASSERT_EQ(std::system(part("manifest.json").c_str()), 0);
    ASSERT_EQ(std::system(part("manifest.sig").c_str()), 0);
    const auto verify = "openssl pkeyutl -verify -rawin -pubin -inkey " + path("keys/theirs.pub") + " -in " + path("manifest.json") +
                        " -sigfile " + path("manifest.sig") + " > /dev/null 2>&1";
    EXPECT_EQ(std::system(verify.c_str()), 0);
    folder.write("manifest.json", text_of_file(path("manifest.json")) + " ");
    EXPECT_NE(std::system(verify.c_str()), 0);
}

TEST_F(BundleCommand, AKeyIsNeverWrittenOver) {
    ASSERT_EQ(bundle({"keygen", "plant", "-o", path("")}).code, exit_ok);
    const auto before = text_of_file(path("plant.key"));
    const auto again = bundle({"keygen", "plant", "-o", path("")});
    EXPECT_EQ(again.code, exit_bad_file);
    EXPECT_THAT(again.err, HasSubstr("there is such a file already"));
    EXPECT_EQ(text_of_file(path("plant.key")), before);
    EXPECT_EQ(bundle({"keygen", "../plant"}).code, exit_usage);
}

// -o with the name beside it: the machine file, the key, a folder.
TEST_F(BundleCommand, OnlyABundleIsWrittenOver) {
    ASSERT_EQ(bundle({"keygen", "plant", "-o", path("")}).code, exit_ok);
    ASSERT_EQ(make("1.0").code, exit_ok);
    for (const char* name : {"cell/press.yaml", "plant.key"}) {
        const auto before = text_of_file(path(name));
        const auto refused = bundle({"make", path("cell/press.yaml"), "--version", "1.0", "--key", path("plant.key"), "-o", path(name)});
        EXPECT_EQ(refused.code, exit_bad_file) << name;
        EXPECT_THAT(refused.err, HasSubstr("which is no bundle")) << name;
        EXPECT_EQ(text_of_file(path(name)), before) << name;
    }
    EXPECT_THAT(bundle({"make", path("cell/press.yaml"), "--version", "1.0", "-o", path("cell")}).err, HasSubstr("there is such a folder"));
    EXPECT_EQ(bundle({"make", path("cell/press.yaml"), "--version", "1.1", "-o", path("1.0.twb")}).code, exit_ok);
}

TEST_F(BundleCommand, WordsThatAreWrongAreSaidToBe) {
    EXPECT_EQ(make("1 0").code, exit_usage);
    EXPECT_EQ(make("1.0", {"--key", path("tables/cut.csv")}).code, exit_bad_file);
    EXPECT_THAT(make("1.0", {"--key", path("none.key")}).err, HasSubstr("No such file"));
    EXPECT_THAT(on_host({"install", path("cell/press.yaml")}, true).err, HasSubstr("it does not begin as a bundle does"));
    EXPECT_THAT(on_host({"activate", "press", "1.0"}, true).err, HasSubstr("no bundle is installed in"));
    EXPECT_THAT(on_host({"list"}).out, HasSubstr("no bundle is installed in"));
    EXPECT_THAT(in_process({"run"}).err, HasSubstr("nothing is named that shall run"));
    EXPECT_THAT(in_process({"run", "x.yaml", "--bundle", "press"}).err, HasSubstr("a file and a bundle are named"));
    EXPECT_THAT(in_process({"run", "--bundle", "press", "--root", path("root")}).err, HasSubstr("no bundle is installed in"));
}

TEST_F(BundleCommand, APathThatOnlyThisComputerHasIsRefused) {
    auto text = machine_text();
    text.replace(text.find("../tables/cut.csv"), 17, path("tables/cut.csv"));
    folder.write("cell/press.yaml", text);
    const auto made = make("1.0");
    EXPECT_EQ(made.code, exit_bad_file);
    EXPECT_THAT(made.err, HasSubstr("which is a path of this computer alone"));
}

}  // namespace
}  // namespace taktwerk::apps
