// A bundle as a whole: who signed it, and that no bit of a signed one can be another.

#include "runtime/bundle/bundle_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/bundle/durable.hpp"
#include "tests/runtime/bundle/small_bundle.hpp"

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Result<BundleFile> open(const std::string& text, const Trust& trust) {
    return BundleFile::read(std::make_unique<BundleText>(text), "a.twb", trust);
}

/// Taken with every file of it, or the code of why not.
std::string verdict(const std::string& text, const Trust& trust) {
    const auto bundle = open(text, trust);
    if (!bundle) return bundle.error().code;
    for (const auto& file : bundle->manifest().files)
        if (const auto content = bundle->content(file); !content) return content.error().code;
    return "taken";
}

TEST(BundleFile, GivesWhatWasPacked) {
    const auto bundle = open(small_bundle(), nobody());
    ASSERT_TRUE(bundle) << bundle.error().text();
    EXPECT_EQ(bundle->manifest().name, "cell");
    ASSERT_EQ(bundle->manifest().files.size(), 3u);
    EXPECT_EQ(*bundle->content(bundle->manifest().files[1]), std::string(700, '\x7f'));
    EXPECT_EQ(bundle->bytes(), std::string("name: cell # 1.0\n").size() + 700);
    EXPECT_EQ(bundle->signer().kind, Signer::Kind::unsigned_);
}

// The seed of the fuzz target was put together by hand from POSIX.1-1988, not by this tree. Its first byte is the target's.
TEST(BundleFile, IsTheTarOfTheStandard) {
    const auto seed = text_of_file(std::string(TAKTWERK_SOURCE_DIR) + "/tests/fuzz/corpus/bundle_fuzz/whole");
    ASSERT_GT(seed.size(), 1u);
    EXPECT_EQ(verdict(seed.substr(1), nobody()), "taken");
}

TEST(BundleFile, UnpackedItIsWholeAndVerified) {
    const TemporaryFolder folder;
    const auto key = new_key();
    const auto bundle = open(small_bundle(small_manifest(), &key), nobody());
    ASSERT_TRUE(bundle);
    ASSERT_TRUE(bundle->unpack(folder.path()));
    const auto there = read_unpacked(folder.path());
    ASSERT_TRUE(there) << there.error().text();
    EXPECT_EQ(text_of_file(there->machine_file()), "name: cell # 1.0\n");
    EXPECT_TRUE(verify(*there));
    EXPECT_TRUE(trust_in(key).judge(there->manifest_text, there->signature, "a")) << "signed as it was";

    folder.write("files/machine/feeder.so", std::string(699, '\x7f') + "x");
    const auto altered = verify(*there);
    ASSERT_FALSE(altered);
    EXPECT_EQ(altered.error().code, "bundle.sum");
    EXPECT_THAT(altered.error().what, HasSubstr("machine/feeder.so"));
    fs::remove(folder.path() / "files/machine/feeder.so");
    EXPECT_EQ(verify(*there).error().code, "bundle.unreadable");
    fs::create_symlink("/dev/zero", folder.path() / "files/machine/feeder.so");
    EXPECT_EQ(verify(*there).error().code, "bundle.unreadable") << "no link is followed";
}

TEST(BundleFile, OnceAKeyIsTrustedOnlyItsBundlesAreTaken) {
    const auto ours = new_key(), theirs = new_key();
    const auto unsigned_one = small_bundle(), signed_one = small_bundle(small_manifest(), &ours),
               foreign = small_bundle(small_manifest(), &theirs);
    EXPECT_EQ(verdict(unsigned_one, nobody()), "taken");
    EXPECT_EQ(open(foreign, nobody())->signer().kind, Signer::Kind::unjudged);
    EXPECT_EQ(verdict(unsigned_one, trust_in(ours)), "bundle.unsigned");
    EXPECT_EQ(verdict(foreign, trust_in(ours)), "bundle.foreign");
    EXPECT_EQ(verdict(signed_one, trust_in(ours)), "taken");
    const auto signer = open(signed_one, trust_in(ours))->signer();
    EXPECT_EQ(signer.kind, Signer::Kind::trusted);
    EXPECT_EQ(words_of(signer), "signed by plant (" + ours.public_half().fingerprint() + ")");
    const Trust both({{"a", theirs.public_half()}, {"b", ours.public_half()}});
    EXPECT_EQ(open(signed_one, both)->signer().name, "b") << "any of them";
}

TEST(BundleFile, NoBitOfASignedOneCanBeAnother) {
    const auto key = new_key();
    const auto trust = trust_in(key);
    const auto whole = small_bundle(small_manifest(), &key);
    ASSERT_EQ(verdict(whole, trust), "taken");
    for (std::size_t i = 0; i < whole.size(); ++i) {
        auto changed = whole;
        changed[i] = static_cast<char>(changed[i] ^ (1 << (i % 8)));
        ASSERT_NE(verdict(changed, trust), "taken") << "byte " << i;
    }
}

TEST(BundleFile, NoPartOfASignedOneIsTaken) {
    const auto key = new_key();
    const auto whole = small_bundle(small_manifest(), &key);
    for (std::size_t size = 0; size < whole.size(); size += 64) EXPECT_NE(verdict(whole.substr(0, size), trust_in(key)), "taken") << size;
}

/// A container of these files, as `bundle_text` would never write it.
std::string packed(const std::vector<std::pair<std::string, std::string>>& files, std::int64_t stamp = small_time) {
    ContainerText text(stamp);
    for (const auto& [path, bytes] : files) EXPECT_TRUE(text.add(path, bytes)) << path;
    return text.finish();
}

TEST(BundleFile, ItsFilesAreThoseOfItsManifest) {
    auto manifest = small_manifest();
    manifest.programs.clear();
    const std::string machine = "name: cell\n";
    const auto sum = open(small_bundle(), nobody());  // any sum that is right for its file
    ASSERT_TRUE(sum);
    manifest.files = {{"machine/cell.yaml", "machine", machine.size(), std::string(64, '0')}};
    const auto said = text_of(manifest);
    EXPECT_EQ(verdict(packed({{"manifest.json", said}, {"files/machine/cell.yaml", machine}}), nobody()), "bundle.sum");
    EXPECT_EQ(verdict(packed({{"manifest.json", said}}), nobody()), "bundle.damaged") << "missing";
    EXPECT_EQ(verdict(packed({{"manifest.json", said}, {"files/machine/cell.yaml", machine}, {"files/more", ""}}), nobody()),
              "bundle.damaged");
    EXPECT_EQ(verdict(packed({{"manifest.json", said}, {"files/machine/cell.yaml", machine + " "}}), nobody()), "bundle.damaged")
        << "another size";
    EXPECT_EQ(verdict(packed({{"manifest.json", said}, {"machine/cell.yaml", machine}}), nobody()), "bundle.damaged")
        << "outside of files/";
    EXPECT_EQ(verdict(packed({{"files/machine/cell.yaml", machine}, {"manifest.json", said}}), nobody()), "bundle.not_a_bundle");
    EXPECT_EQ(verdict(packed({{"manifest.json", said}, {"files/machine/cell.yaml", machine}}, small_time + 1), nobody()), "bundle.damaged")
        << "stamped with another time";
    EXPECT_EQ(verdict(packed({{"manifest.json", said}, {"manifest.sig", "short"}, {"files/machine/cell.yaml", machine}}), nobody()),
              "bundle.damaged");
    EXPECT_EQ(verdict(packed({{"manifest.json", "{}"}}), nobody()), "bundle.manifest");
}

TEST(BundleFile, AFileThatIsNotThereOrNoFileIsSaidToBe) {
    const TemporaryFolder folder;
    const auto missing = BundleFile::open((folder.path() / "no.twb").string(), nobody());
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().text(), HasSubstr("there is no such file"));
    EXPECT_EQ(BundleFile::open(folder.path().string(), nobody()).error().what, "it is no file");
    EXPECT_EQ(BundleFile::open(folder.write("empty.twb", ""), nobody()).error().code, "bundle.not_a_bundle");
}

TEST(Trust, IsAFolderOfPublicKeys) {
    const TemporaryFolder folder;
    const auto key = new_key(), other = new_key();
    EXPECT_TRUE(Trust::read(folder.path() / "none")->keys().empty()) << "no folder: nobody is trusted";
    folder.write("plant.pub", key.public_half().pem());
    folder.write("builder.pub", other.public_half().pem());
    folder.write("notes.txt", "no key");
    const auto trust = Trust::read(folder.path());
    ASSERT_TRUE(trust) << trust.error().text();
    ASSERT_EQ(trust->keys().size(), 2u);
    EXPECT_EQ(trust->keys()[0].name, "builder");
    EXPECT_EQ(trust->keys()[1].key, key.public_half());
}

TEST(Trust, AKeyThatCannotBeReadIsNoOpenDoor) {
    const TemporaryFolder folder;
    const auto key = new_key();
    folder.write("plant.pub", key.pem());
    const auto secret = Trust::read(folder.path());
    ASSERT_FALSE(secret);
    EXPECT_EQ(secret.error().code, "key.not_public");
    fs::remove(folder.path() / "plant.pub");
    fs::create_directory(folder.path() / "plant.pub");
    EXPECT_EQ(Trust::read(folder.path()).error().code, "trust.unreadable");
    EXPECT_EQ(Trust::read(folder.write("file", "")).error().code, "trust.unreadable") << "a file where the folder should be";
}

// Copied there as it was called elsewhere: without it this computer would go on taking every bundle.
TEST(Trust, AKeyWithAnotherEndingIsNotPassedOver) {
    for (const char* name : {"plant.PUB", "plant.pem", ".pub", "plant"}) {
        const TemporaryFolder folder;
        folder.write(name, new_key().public_half().pem());
        const auto trust = Trust::read(folder.path());
        ASSERT_FALSE(trust) << name;
        EXPECT_EQ(trust.error().code, "trust.unreadable") << name;
        EXPECT_THAT(trust.error().text(), ::testing::HasSubstr(".pub")) << name;
    }
}

TEST(Trust, WhereOthersMayWriteNobodyIsTrusted) {
    const TemporaryFolder folder;
    const fs::path key = folder.write("plant.pub", new_key().public_half().pem());
    ASSERT_TRUE(Trust::read(folder.path()));
    const auto with = [&](const fs::path& path, fs::perms more) {
        fs::permissions(path, more, fs::perm_options::add);
        const auto trust = Trust::read(folder.path());
        fs::permissions(path, more, fs::perm_options::remove);
        return trust ? std::string("taken") : trust.error().code + " " + trust.error().subject;
    };
    EXPECT_EQ(with(folder.path(), fs::perms::others_write), "trust.open " + folder.path().string());
    EXPECT_EQ(with(key, fs::perms::others_write), "trust.open " + key.string());
    ASSERT_TRUE(Trust::read(folder.path())) << "as it was";
    if (::geteuid() != 0) GTEST_SKIP() << "a group that is not one's own takes root";
    ASSERT_EQ(::chown(folder.path().c_str(), 0, 65534), 0);
    EXPECT_EQ(with(folder.path(), fs::perms::group_write), "trust.open " + folder.path().string());
}

TEST(Target, EachReasonIsItsOwn) {
    const auto code = [](const Manifest& manifest, const Host& host) {
        const auto ok = fits(manifest, host, "a.twb");
        return ok ? std::string("fits") : ok.error().code;
    };
    const auto manifest = small_manifest();
    EXPECT_EQ(code(manifest, small_host()), "fits");
    auto host = small_host();
    host.target = "linux-aarch64";
    EXPECT_EQ(code(manifest, host), "bundle.target");
    auto without_programs = manifest;
    without_programs.programs.clear();
    EXPECT_EQ(code(without_programs, host), "fits") << "a machine without programs is for every computer";
    host = small_host();
    host.version = "0.0.9";
    EXPECT_EQ(code(manifest, host), "bundle.older_runtime");
    host = small_host();
    host.abi += 1;
    EXPECT_EQ(code(manifest, host), "bundle.abi");
    EXPECT_THAT(fits(manifest, host, "a.twb").error().what,
                HasSubstr("program 'feeder' was built with SDK 0.1.0 (interface 8, ABI 1122334455667788)"));
}

}  // namespace
}  // namespace taktwerk::runtime
