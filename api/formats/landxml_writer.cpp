// SPDX-License-Identifier: Apache-2.0
#include "api/formats/landxml_writer.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "api/edge_chains.hpp"
#include "api/formats/json_writer.hpp"

namespace tinsmith::api {
namespace {

/// Text in UTF-8 inside an attribute. What XML 1.0 has no place for becomes a question mark.
std::string attribute(std::string_view text) {
    constexpr std::string_view kNoCharacters[] = {"\xEF\xBF\xBE", "\xEF\xBF\xBF"};
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (std::ranges::find(kNoCharacters, text.substr(i, 3)) != std::end(kNoCharacters)) {
            out.push_back('?');
            i += 2;
            continue;
        }
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\t':
            case '\n':
            case '\r':
                out.push_back(' ');
                break;
            default:
                out.push_back(static_cast<unsigned char>(c) < ' ' ? '?' : c);
        }
    }
    return out;
}

void append_place(std::string& out, const core::Point3& p) {
    json::append_coordinate(out, p.y);
    out.push_back(' ');
    json::append_coordinate(out, p.x);
    out.push_back(' ');
    json::append_coordinate(out, p.z);
}

/// Areas and volumes are in the unit's own square and cube; the rest has nothing to say here.
void append_units(std::string& out, std::string_view unit) {
    if (unit == "metre") {
        out +=
            "<Units><Metric areaUnit=\"squareMeter\" linearUnit=\"meter\" "
            "volumeUnit=\"cubicMeter\" temperatureUnit=\"celsius\" pressureUnit=\"HPA\"/>"
            "</Units>\n";
        return;
    }
    out += "<Units><Imperial areaUnit=\"squareFoot\" linearUnit=\"";
    out += unit == "foot" ? "foot" : "USSurveyFoot";
    out +=
        "\" volumeUnit=\"cubicFeet\" temperatureUnit=\"fahrenheit\" pressureUnit=\"inHG\"/>"
        "</Units>\n";
}

void append_system(std::string& out, std::string_view crs) {
    constexpr std::string_view kEpsg = "EPSG:";
    if (crs.empty()) return;
    out += "<CoordinateSystem name=\"" + attribute(crs) + "\"";
    if (crs.starts_with(kEpsg))
        out.append(" epsgCode=\"").append(attribute(crs.substr(kEpsg.size()))).append("\"");
    out += "/>\n";
}

void append_breaklines(std::string& out, const core::MeshData& mesh) {
    out += "<SourceData>\n<Breaklines>\n";
    for (const auto& line : chain_edges(mesh.constraints)) {
        out += "<Breakline brkType=\"standard\"><PntList3D>";
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (i > 0) out.push_back(' ');
            append_place(out, mesh.vertices[line[i]]);
        }
        out += "</PntList3D></Breakline>\n";
    }
    out += "</Breaklines>\n</SourceData>\n";
}

void append_definition(std::string& out, const core::MeshData& mesh) {
    out += "<Definition surfType=\"TIN\">\n<Pnts>\n";
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        out += "<P id=\"";
        json::append_number(out, i + 1);
        out += "\">";
        append_place(out, mesh.vertices[i]);
        out += "</P>\n";
    }
    out += "</Pnts>\n<Faces>\n";
    for (const auto& [a, b, c] : mesh.triangles) {
        out += "<F>";
        json::append_number(out, std::uint64_t{a} + 1);
        out.push_back(' ');
        json::append_number(out, std::uint64_t{b} + 1);
        out.push_back(' ');
        json::append_number(out, std::uint64_t{c} + 1);
        out += "</F>\n";
    }
    out += "</Faces>\n</Definition>\n";
}

}  // namespace

std::string write_landxml(const core::MeshData& mesh, const LandXmlAbout& about) {
    constexpr std::size_t kOfALine = 72;
    std::string out;
    out.reserve((mesh.vertices.size() + mesh.triangles.size()) * kOfALine);
    const std::string name = about.name.empty() ? "terrain" : attribute(about.name);
    // The schema wants a day and a time; the same mesh shall have the same bytes.
    out +=
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\" "
        "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xsi:schemaLocation=\"http://www.landxml.org/schema/LandXML-1.2 "
        "http://www.landxml.org/schema/LandXML-1.2/LandXML-1.2.xsd\" "
        "version=\"1.2\" date=\"1970-01-01\" time=\"00:00:00\" readOnly=\"false\" "
        "language=\"English\">\n";
    append_units(out, about.unit);
    append_system(out, about.crs);
    out += "<Project name=\"" + name + "\"/>\n<Application name=\"Tinsmith\"/>\n";
    out += "<Surfaces>\n<Surface name=\"" + name + "\">\n";
    if (about.constraints && !mesh.constraints.empty()) append_breaklines(out, mesh);
    append_definition(out, mesh);
    out += "</Surface>\n</Surfaces>\n</LandXML>\n";
    return out;
}

}  // namespace tinsmith::api
