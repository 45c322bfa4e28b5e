// Whatever words and numbers a vendor writes: what becomes of his device is refused, or it is a device file that is read back as what he meant.

#include <gtest/gtest.h>

#include <array>
#include <random>

#include <fmt/format.h>

#include "config/device_file/device_file_text.hpp"
#include "config/device_file/device_loader.hpp"
#include "config/esi_import/esi_import.hpp"
#include "config/esi_import/import_check.hpp"
#include "tests/ecat/esi/esi_text.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::config {
namespace {

/// A device as XML, and what was meant by it.
struct MeantDevice {
    struct Pdo {
        std::uint16_t index = 0;
        bool rx = false, assigned = true;
        std::vector<ecat::PdoEntry> entries;
    };
    std::string xml;
    ecat::Identity identity;
    std::vector<Pdo> pdos;
    std::vector<std::pair<std::uint16_t, std::int64_t>> values;  // of the dictionary, DINT, with their defaults
    std::vector<std::pair<std::uint16_t, std::int64_t>> startup;
};

class VendorsPen {
public:
    explicit VendorsPen(unsigned seed) : random_(seed) {}

    MeantDevice device() {
        MeantDevice out;
        out.identity = {9999, 1 + below(0xFFFFFF), below(0x7FFFFFFF), 0};
        const auto head = fmt::format("<Type ProductCode=\"{}\" RevisionNo=\"{}\">{}</Type>\n<Name>{}</Name>\n",
                                      number(out.identity.product), number(out.identity.revision), words(), words());
        // In the order of the scheme; the mailbox and the dictionary lie between.
        std::string pdos, objects, commands;
        std::uint16_t rx = 0x1600, tx = 0x1A00, object = 0x6000;
        const unsigned count = 1 + below(5);
        for (unsigned n = 0; n < count; ++n) pdos += pdo(out, once_in(2) ? rx : tx, object);
        const unsigned values = below(6);
        for (unsigned n = 0; n < values; ++n) {
            const auto index = static_cast<std::uint16_t>(0x2000 + n);
            const auto value = static_cast<std::int32_t>(random_());
            out.values.emplace_back(index, value);
            objects += fmt::format(
                "<Object><Index>{}</Index><Name>{}</Name><Type>DINT</Type><BitSize>32</BitSize><Info><DefaultValue>{}</"
                "DefaultValue><Unit>{}"
                "</Unit></Info><Flags><Access>rw</Access></Flags></Object>\n",
                number(index), words(), value, words());
            if (!once_in(3)) continue;
            out.startup.emplace_back(index, value);
            const auto bits = static_cast<std::uint32_t>(value);
            commands += fmt::format(
                "<InitCmd><Transition>PS</Transition><Index>{}</Index><SubIndex>0</SubIndex><Data>{:02X}{:02X}{:02X}{:02X}</"
                "Data><Comment>{}"
                "</Comment></InitCmd>\n",
                number(index), bits & 0xFF, bits >> 8 & 0xFF, bits >> 16 & 0xFF, bits >> 24, words());
        }
        out.xml = "<Device Physics=\"YY\">\n" + head + "<Profile><Dictionary><DataTypes/><Objects>" + objects +
                  "</Objects></Dictionary></Profile>\n"
                  "<Sm StartAddress=\"#x1000\" DefaultSize=\"128\" ControlByte=\"#x26\" Enable=\"1\">MBoxOut</Sm>\n"
                  "<Sm StartAddress=\"#x1080\" DefaultSize=\"128\" ControlByte=\"#x22\" Enable=\"1\">MBoxIn</Sm>\n"
                  "<Sm StartAddress=\"#x1100\" ControlByte=\"#x64\" Enable=\"1\">Outputs</Sm>\n"
                  "<Sm StartAddress=\"#x1400\" ControlByte=\"#x20\" Enable=\"1\">Inputs</Sm>\n" +
                  pdos + "<Mailbox><CoE PdoAssign=\"1\" PdoConfig=\"1\">" + commands + "</CoE></Mailbox>\n</Device>\n";
        return out;
    }

private:
    std::uint32_t below(std::uint32_t n) { return std::uniform_int_distribution<std::uint32_t>{0, n - 1}(random_); }
    bool once_in(unsigned n) { return below(n) == 0; }

    std::string pdo(MeantDevice& out, std::uint16_t& next, std::uint16_t& object) {
        MeantDevice::Pdo pdo;
        pdo.rx = next < 0x1A00;
        pdo.index = next++;
        pdo.assigned = !once_in(4);
        auto xml = fmt::format("<{}{}><Index>{}</Index><Name>{}</Name>\n", pdo.rx ? "RxPdo" : "TxPdo",
                               pdo.assigned ? (pdo.rx ? " Sm=\"2\"" : " Sm=\"3\"") : "", number(pdo.index), words());
        const unsigned entries = 1 + below(6);
        for (unsigned n = 0; n < entries; ++n) {
            static constexpr std::array<std::pair<const char*, std::uint8_t>, 5> types{
                {{"USINT", 8}, {"INT", 16}, {"UDINT", 32}, {"SINT", 8}, {"LINT", 64}}};
            const auto& [type, bits] = types[below(types.size())];
            if (once_in(8)) {
                pdo.entries.push_back({0, 0, 8});
                xml += "<Entry><Index>0</Index><BitLen>8</BitLen></Entry>\n";
                continue;
            }
            if (once_in(2)) object = static_cast<std::uint16_t>(object + 0x10);
            const auto sub = static_cast<std::uint8_t>(pdo.entries.size() + 1);
            pdo.entries.push_back({object, sub, bits});
            xml += fmt::format(
                "<Entry><Index>{}</Index><SubIndex>{}</SubIndex><BitLen>{}</BitLen><Name>{}</Name><DataType>{}</DataType></Entry>\n",
                number(object), number(sub), number(bits), words(), type);
        }
        object = static_cast<std::uint16_t>(object + 0x10);
        out.pdos.push_back(pdo);
        return xml + (pdo.rx ? "</RxPdo>\n" : "</TxPdo>\n");
    }
    std::string number(std::uint32_t value) {
        switch (below(5)) {
            case 0: return std::to_string(value);
            case 1: return fmt::format("#x{:X}", value);
            case 2: return fmt::format("0x{:x}", value);
            case 3: return fmt::format("#x0x{:08X}", value);
            default: return fmt::format(" {} ", value);
        }
    }
    /// What breaks YAML, lines and terminals where nobody looks.
    std::string words() {
        static constexpr std::array<const char*, 44> pieces{"Position",
                                                            "actual value",
                                                            "a: b",
                                                            "- x",
                                                            "# c",
                                                            "'",
                                                            "\"",
                                                            "\\",
                                                            "\\n",
                                                            "\n",
                                                            "\t",
                                                            "&#13;",
                                                            "&#10;ebus: 99 mA",
                                                            "&#13;ebus: 99 mA",
                                                            "&#27;[31m",
                                                            "&#0;",
                                                            "&#x85;",
                                                            "&#x2028;",
                                                            "&#xFEFF;",
                                                            "&#xD800;",
                                                            "&#x10FFFF;",
                                                            "null",
                                                            "true",
                                                            "yes",
                                                            "~",
                                                            "0x10",
                                                            "1e5",
                                                            "%YAML 1.2",
                                                            "@",
                                                            "`",
                                                            "{ a: b }",
                                                            "[a, b",
                                                            ", ",
                                                            "| ",
                                                            "!!binary ",
                                                            "&amp;a",
                                                            "*a",
                                                            "---",
                                                            "...",
                                                            "中文",
                                                            "µ",
                                                            "<![CDATA[<a> # \"]]>",
                                                            "<!-- x -->",
                                                            ""};
        std::string out;
        const unsigned count = below(4);
        for (unsigned n = 0; n < count; ++n) out += pieces[below(pieces.size())];
        if (once_in(60)) out += std::string(3000, 'x');
        return out;
    }
    std::mt19937 random_;
};

void expect_as_meant(const MeantDevice& meant, const LoadedDevice& back) {
    const auto& device = *back.device;
    EXPECT_EQ(device.identity, meant.identity);
    EXPECT_FALSE(device.ebus_current) << "nobody said what it takes";
    std::array<std::size_t, 2> at{};
    for (const auto& pdo : meant.pdos) {
        const auto& pdos = pdo.rx ? device.rx_pdos : device.tx_pdos;
        const auto& assigned = pdo.rx ? device.rx_assigned : device.tx_assigned;
        auto& place = at[pdo.rx ? 1 : 0];
        ASSERT_LT(place, pdos.size());
        EXPECT_EQ(pdos[place].index, pdo.index);
        EXPECT_EQ(pdos[place].entries, pdo.entries);
        EXPECT_EQ(std::count(assigned.begin(), assigned.end(), pdo.index), pdo.assigned ? 1 : 0);
        ++place;
    }
    EXPECT_EQ(device.rx_pdos.size(), at[1]);
    EXPECT_EQ(device.tx_pdos.size(), at[0]);
    for (const auto& [index, value] : meant.values) {
        const auto* object = find_object(device, index, 0);
        ASSERT_NE(object, nullptr);
        EXPECT_EQ(object->value, value);
        EXPECT_EQ(object->type, ecat::DataType::I32);
    }
    ASSERT_EQ(back.startup.size(), meant.startup.size());
    for (std::size_t n = 0; n < meant.startup.size(); ++n) {
        EXPECT_EQ(back.startup[n].index, meant.startup[n].first);
        EXPECT_EQ(back.startup[n].value, meant.startup[n].second);
    }
}

TEST(EsiImports, AreReadBackAsTheVendorMeantOrRefused) {
    std::size_t taken = 0;
    const auto cases = property_cases(300);
    for (unsigned seed = 1; seed <= cases && !testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        VendorsPen pen(seed);
        const auto meant = pen.device();
        const auto file = ecat::esi::parsed(ecat::esi::file_with(meant.xml));
        ASSERT_TRUE(file) << file.error().text() << meant.xml;
        ASSERT_EQ(file->devices().size(), 1u);
        const auto import = import_device(file->read(0), file->vendor_name(), "pen.xml", {});
        ASSERT_TRUE(import) << import.error().text() << meant.xml;
        const auto text = device_file_text(import->file, import->file.title + ": made of the vendor's file.");
        const auto problems = problems_of_device(import->file.name, text);
        EXPECT_TRUE(problems.empty()) << problems.front().text() << "\n" << text;
        const auto loaded = load_device_text(import->file.name + ".yaml", text);
        const auto* device = std::get_if<LoadedDevice>(&loaded);
        if (device == nullptr) continue;
        ++taken;
        expect_as_meant(meant, *device);
        EXPECT_EQ(device->title, import->file.title);
        for (std::size_t n = 0; n < import->file.objects.size(); ++n) {
            const auto& row = import->file.objects[n].object;
            const auto* object = find_object(*device->device, row.index, row.sub);
            ASSERT_NE(object, nullptr);
            EXPECT_EQ(object->name, row.name);
        }
        if (testing::Test::HasFailure()) std::printf("%s\n%s\n", meant.xml.c_str(), text.c_str());
    }
    EXPECT_GT(taken, cases * 9 / 10);
}

}  // namespace
}  // namespace taktwerk::config
