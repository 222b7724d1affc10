// SPDX-License-Identifier: Apache-2.0
#include "api/formats/edit_json.hpp"

#include <array>
#include <utility>
#include <vector>

#include "api/formats/json_reader.hpp"
#include "api/formats/json_reader_values.hpp"
#include "api/formats/plane_members.hpp"

namespace tinsmith::api {

namespace {

using json::Object;
using json::quoted;
using json::Reader;
using json::Scalar;

struct OperationRow {
    EditKind operation;
    std::string_view name;
    std::string_view members;  ///< that it takes, each between blanks
};
constexpr std::array kOperations{
    OperationRow{EditKind::Set, "set", " elevation plane slope azimuth point border rim taper "},
    OperationRow{EditKind::Offset, "offset", " by border rim taper "},
    OperationRow{EditKind::Smooth, "smooth", " passes border "},
    OperationRow{EditKind::Remove, "remove", " "},
    OperationRow{EditKind::Keep, "keep", " "},
};
constexpr std::array<std::string_view, 10> kOfSome{
    "elevation", "plane", "slope", "azimuth", "point", "by", "passes", "border", "rim", "taper"};

/// A length above 0.
class Width : public json::Number {
  public:
    void scalar(Reader& reader, const Scalar& value) override {
        if (value.is_number() && !(value.number > 0.0)) {
            return reader.fault("NUMBER_OUT_OF_RANGE",
                                "Expected a length above 0, in the session's unit.");
        }
        Number::scalar(reader, value);
    }
};

class EditBody : public Object {
  public:
    EditBody() {
        std::vector<json::Member> members = plane_.members();
        members.insert(members.end(), {{"operation", &operation_},
                                       {"polygon", &polygon_},
                                       {"by", &by_},
                                       {"passes", &passes_},
                                       {"border", &border_},
                                       {"rim", &rim_},
                                       {"taper", &taper_}});
        expect(std::move(members));
    }
    EditRequest take() { return std::move(request_); }

  protected:
    std::string_view expected() const override {
        return "an object such as {\"operation\": \"set\", \"polygon\": \"p1\", \"elevation\": "
               "412.5}";
    }

    void ended(Reader& reader) override {
        if (!has("polygon")) {
            reader.fault("MEMBER_MISSING",
                         "\"polygon\" is missing: the id of one of the session's polygons.");
        } else if (request_.polygon.empty() && reader.log().empty()) {
            add(reader, "TEXT_EMPTY", "polygon", "An id has a letter at least.");
        }
        const OperationRow* const row = find_operation(reader);
        if (row == nullptr) return;
        request_.operation = row->operation;
        for (const std::string_view name : kOfSome) {
            if (!has(name) || row->members.find(" " + std::string(name) + " ") != row->members.npos)
                continue;
            add(reader, "CONTRADICTION", name,
                quoted(name) + " has no meaning with operation " + quoted(row->name) +
                    ": leave it out.");
        }
        read_change(reader);
        if (row->members.find(" border ") != row->members.npos) read_border(reader);
    }

  private:
    static void add(Reader& reader, std::string code, std::string_view name, std::string detail) {
        reader.add(FaultKind::Invalid,
                   {std::move(code), std::move(detail), json::pointer_to(reader.pointer(), name)});
    }
    void require(Reader& reader, std::string_view name) {
        if (has(name)) return;
        reader.fault("MEMBER_MISSING", quoted(name) + " is missing: operation " +
                                           quoted(operation_text_) + " needs it.");
    }

    const OperationRow* find_operation(Reader& reader) {
        for (const OperationRow& row : kOperations)
            if (row.name == operation_text_) return &row;
        const std::string known = "one of set, offset, smooth, remove and keep.";
        if (!has("operation")) {
            reader.fault("MEMBER_MISSING", "\"operation\" is missing: give " + known);
        } else if (!operation_text_.empty() || reader.log().empty()) {
            add(reader, "UNKNOWN_OPERATION", "operation",
                quoted(operation_text_) + " is no operation: give " + known);
        }
        return nullptr;
    }

    void read_change(Reader& reader) {
        switch (request_.operation) {
            case EditKind::Set:
                return read_plane(reader);
            case EditKind::Offset:
                require(reader, "by");
                request_.by = by_.number();
                break;
            case EditKind::Smooth:
                require(reader, "passes");
                break;
            case EditKind::Remove:
            case EditKind::Keep:
                break;
        }
    }

    void read_plane(Reader& reader) {
        const int given = plane_.count(*this);
        if (given != 1) {
            reader.fault(given == 0 ? "MEMBER_MISSING" : "CONTRADICTION",
                         "Give one thing to set: \"elevation\", or \"plane\" of three points, or "
                         "\"slope\", \"azimuth\" and \"point\".");
        }
        plane_.check(reader, *this);
        if (!reader.log().empty()) return;
        if (const auto plane = plane_.take(reader, *this)) request_.plane = *plane;
    }

    /// Requires: the operation takes a border.
    void read_border(Reader& reader) {
        const bool is_new = border_text_ == "new";
        if (has("border") && !is_new && border_text_ != "old" &&
            (!border_text_.empty() || reader.log().empty())) {
            add(reader, "INVALID_VALUE", "border", "border is \"old\" or \"new\".");
        }
        request_.moves_border = is_new || has("taper");
        if (request_.operation == EditKind::Smooth) return;
        if (has("taper") && has("border") && border_text_ == "old") {
            add(reader, "CONTRADICTION", "border",
                "With \"taper\" the border takes the new elevation, with \"border\": \"old\" it "
                "does not: leave one of them out.");
        }
        if (has("rim") && has("taper")) {
            add(reader, "CONTRADICTION", "rim",
                "\"rim\" lets the ground climb inside the border, \"taper\" outside: leave one of "
                "them out.");
        } else if (has("rim") && is_new) {
            add(reader, "CONTRADICTION", "rim",
                "\"rim\" is for a border that stays, with \"border\": \"new\" it moves: leave one "
                "of them out.");
        }
        request_.rim_is_given = has("rim");
        if (has("taper")) request_.taper = taper_.number();
        if (!request_.moves_border) request_.rim = has("rim") ? rim_.number() : kDefaultRim;
    }

    EditRequest request_;
    std::string operation_text_, border_text_;
    json::PlaneMembers plane_;
    json::Text operation_{operation_text_};
    json::Text polygon_{request_.polygon};
    json::Text border_{border_text_};
    json::Number by_;
    json::Whole passes_{request_.passes, 1, kMostPasses};
    Width rim_, taper_;
};

}  // namespace

std::string_view edit_name(EditKind operation) {
    for (const OperationRow& row : kOperations)
        if (row.operation == operation) return row.name;
    return {};
}

Parsed<EditRequest> read_edit_request(std::string_view body, const ReadLimits& limits) {
    EditBody root;
    Reader reader(root, limits);
    json::read(body, reader);
    if (!reader.log().empty()) return std::move(reader.log()).refusal<EditRequest>();
    return root.take();
}

}  // namespace tinsmith::api
