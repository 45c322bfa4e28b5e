#include "ecat/esi/esi_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

#include "ecat/esi/element.hpp"
#include "ecat/esi/esi_number.hpp"
#include "ecat/esi/read_parts.hpp"
#include "ecat/esi/text_encoding.hpp"

namespace taktwerk::ecat::esi {

namespace {

constexpr std::size_t most_bytes = 256u << 20u;  // the largest file in the field has 30 MB

Error too_large(const std::string& file, std::uintmax_t bytes) {
    return {"esi.too_large", file, fmt::format("it has {} bytes; ESI files have some megabytes", bytes), "give the vendor's XML file"};
}

Error not_esi(const SourceText& source, pugi::xml_node root) {
    const std::string name = root.name();
    std::string remedy = "give the vendor's ESI file: its first element is EtherCATInfo";
    if (name == "EtherCATModule") remedy = "it holds modules alone: give the file of the coupler or device that they go into";
    if (name == "EtherCATDict") remedy = "it is the dictionary of a device: give the file that names it in a DictionaryFile element";
    if (name == "EtherCATConfig") remedy = "it is an ENI file, what a configurator made for one bus: give the vendors' ESI files";
    if (name == "EtherCATDiag") remedy = "it holds texts of messages: give the device's own file";
    return {"esi.not_esi", source.place(root.offset_debug()),
            fmt::format("its first element is '{}', not EtherCATInfo", name.substr(0, 60)), std::move(remedy)};
}

}  // namespace

struct EsiFile::Content {
    SourceText source;
    pugi::xml_document xml;
    std::uint32_t vendor = 0;
    std::string vendor_name;
    std::vector<pugi::xml_node> nodes;  // of the devices
    std::vector<EsiHeading> headings;
    std::vector<Error> remarks;

    void read_vendor(const Element& root) {
        const auto vendor_element = root.child("Vendor");
        if (!vendor_element) {
            root.problem("esi.missing", "it has no Vendor", "add <Vendor><Id>...</Id></Vendor>, or ask the vendor for a complete file");
            return;
        }
        // "ID" is in files of some.
        const char* key = vendor_element.child("Id") ? "Id" : vendor_element.child("ID") ? "ID" : "Id";
        vendor = static_cast<std::uint32_t>(vendor_element.required_number_of(key, 0, u32).value_or(0));
        vendor_name = vendor_element.in_english("Name");
    }

    void read_headings(const Element& descriptions) {
        std::map<std::string, std::string> groups;
        if (const auto all = descriptions.child("Groups"))
            for (const auto& group : all.children("Group")) groups.emplace(group.text_of("Type"), group.in_english("Name"));
        const auto devices = descriptions.child("Devices");
        if (!devices) return;
        for (const auto& device : devices.children("Device")) {
            Findings findings;
            headings.push_back(read_heading(Element(device.node(), source, findings), vendor));
            nodes.push_back(device.node());
            const auto type = device.text_of("GroupType");
            const auto group = groups.find(type);
            headings.back().group = group == groups.end() || group->second.empty() ? type : group->second;
            std::copy_if(findings.problems.begin(), findings.problems.end(), std::back_inserter(remarks),
                         [](const Error& error) { return error.code != "esi.no_product"; });
        }
        hide();
    }

    /// HideType: a device names the revisions of its product that it takes the place of.
    void hide() {
        std::set<std::pair<std::uint32_t, std::uint32_t>> replaced;
        for (const auto& heading : headings)
            for (const auto revision : heading.replaces)
                if (revision != heading.identity.revision) replaced.emplace(heading.identity.product, revision);
        for (auto& heading : headings)
            if (replaced.count({heading.identity.product, heading.identity.revision}) != 0) heading.hidden = true;
    }

    [[nodiscard]] std::vector<EsiModule> modules_for(const EsiSlots& slots, Findings& findings) const {
        std::vector<EsiModule> out;
        const auto all = xml.document_element().child("Descriptions").child("Modules");
        for (auto node = all.child("Module"); node; node = node.next_sibling("Module")) {
            Findings of_this;
            auto module = read_module(Element(node, source, of_this));
            if (!fits(slots, module)) continue;
            out.push_back(std::move(module));
            findings.problems.insert(findings.problems.end(), of_this.problems.begin(), of_this.problems.end());
            findings.remarks.insert(findings.remarks.end(), of_this.remarks.begin(), of_this.remarks.end());
            for (const auto& [path, unread] : of_this.unread) {
                auto& sum = findings.unread[path];
                if (sum.count == 0) sum = unread;
                else sum.count += unread.count;
            }
        }
        return out;
    }
};

EsiFile::EsiFile(std::unique_ptr<Content> content) : content_(std::move(content)) {}
EsiFile::EsiFile(EsiFile&&) noexcept = default;
EsiFile& EsiFile::operator=(EsiFile&&) noexcept = default;
EsiFile::~EsiFile() = default;

Result<EsiFile> EsiFile::parse(std::span<const std::byte> bytes, std::string name) {
    if (bytes.size() > most_bytes) return too_large(name, bytes.size());
    auto text = decode_text(bytes, name);
    if (!text) return text.error();
    auto content = std::make_unique<Content>();
    auto& source = content->source;
    source.file = std::move(name);
    source.find_lines(text->utf8);
    const auto parsed = content->xml.load_buffer(text->utf8.data(), text->utf8.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed) {
        const bool nothing = parsed.status == pugi::status_no_document_element;
        return Error{"esi.xml", nothing ? source.file : source.place(parsed.offset),
                     nothing ? "it is no XML file: there is no element in it" : fmt::format("it is no sound XML: {}", parsed.description()),
                     "get the file anew from the vendor: it may have been cut or damaged on its way"};
    }
    const auto root = content->xml.document_element();
    if (std::string_view(root.name()) != "EtherCATInfo") return not_esi(source, root);
    for (auto& remark : text->remarks) content->remarks.push_back({"esi.encoding", source.file, std::move(remark), ""});
    Findings findings;
    const Element info(root, source, findings);
    content->read_vendor(info);
    if (!findings.problems.empty()) return findings.problems.front();
    for (const auto& other : info.children("InfoReference"))
        content->remarks.push_back({"esi.other_file", other.place(),
                                    fmt::format("it refers to '{}', which was not read", other.text().substr(0, 200)),
                                    "what is missing here may be in there, such as modules of a coupler"});
    content->read_headings(info.child("Descriptions"));
    return EsiFile(std::move(content));
}

Result<EsiFile> EsiFile::open(const std::string& path) {
    // A folder throws when it is read, a pipe waits for ever, a device has no end.
    std::error_code problem;
    const auto status = std::filesystem::status(path, problem);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        return Error{"esi.file", path, "this is not a regular file", "give the vendor's XML file"};
    if (const auto size = std::filesystem::file_size(path, problem); !problem && size > most_bytes) return too_large(path, size);
    std::ifstream file(path, std::ios::binary);
    std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file.is_open() || file.bad())
        return Error{"esi.file", path, "the file cannot be read", "check its name, and that you may read it"};
    return parse(std::as_bytes(std::span(bytes)), path);
}

const std::string& EsiFile::name() const noexcept { return content_->source.file; }
const std::string& EsiFile::vendor_name() const noexcept { return content_->vendor_name; }
std::uint32_t EsiFile::vendor() const noexcept { return content_->vendor; }
const std::vector<EsiHeading>& EsiFile::devices() const noexcept { return content_->headings; }
const std::vector<Error>& EsiFile::remarks() const noexcept { return content_->remarks; }

EsiReading EsiFile::read(std::size_t n) const {
    Findings findings;
    const Element element(content_->nodes.at(n), content_->source, findings);
    EsiReading out;
    (void)read_heading(element, content_->vendor);  // again, for what is wrong in it
    out.device.heading = content_->headings.at(n);
    read_device(element, out.device);
    if (out.device.slots) out.device.modules = content_->modules_for(*out.device.slots, findings);
    out.problems = std::move(findings.problems);
    out.remarks = std::move(findings.remarks);
    for (auto& [path, unread] : findings.unread) out.unread.push_back(std::move(unread));
    return out;
}

}  // namespace taktwerk::ecat::esi
