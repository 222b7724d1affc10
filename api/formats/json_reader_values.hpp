// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/json_reader.hpp"

/// The expectations that several formats share.
namespace tinsmith::api::json {

/// A text of at most `longest` bytes.
class Text : public Value {
  public:
    explicit Text(std::string& out, std::size_t longest = 200) : out_(out), longest_(longest) {}
    void scalar(Reader& reader, const Scalar& value) override;

  protected:
    std::string_view expected() const override { return "a text"; }

  private:
    std::string& out_;
    std::size_t longest_;
};

/// A whole number from `least` to `most`. 3.0 is whole, as in JSON Schema.
class Whole : public Value {
  public:
    Whole(std::uint64_t& out, std::uint64_t least, std::uint64_t most)
        : out_(out), least_(least), most_(most) {}
    void scalar(Reader& reader, const Scalar& value) override;

  protected:
    std::string_view expected() const override { return "a whole number"; }

  private:
    std::uint64_t& out_;
    std::uint64_t least_;
    std::uint64_t most_;
};

/// What may be in a member of an object.
struct Member {
    std::string_view name;
    Value* value = nullptr;  ///< nullptr: known, and passed over
    bool required = false;
};

/// An object with known members. Unknown ones are refused by name, or passed
/// over when the object is not of our making. Used again for each object of its sort.
class Object : public Value, public Container {
  public:
    enum class Unknown { Refuse, PassOver };

    explicit Object(Unknown unknown = Unknown::Refuse) : unknown_(unknown) {}

    /// Requires: at most 32 members.
    void expect(std::vector<Member> members) { members_ = std::move(members); }
    /// Whether the object being read, or last read, had the member so far.
    bool has(std::string_view name) const;

    Container* object(Reader& reader) override;
    Value* member(Reader& reader, std::string_view name) override;
    void close(Reader& reader) override;

  protected:
    std::string_view expected() const override { return "an object"; }
    /// The object begins, or has ended with all required members.
    virtual void begun(Reader&) {}
    virtual void ended(Reader&) {}

  private:
    std::string known() const;

    Unknown unknown_;
    std::vector<Member> members_;
    std::uint32_t seen_ = 0;
};

/// An array of exactly so many numbers: a position, a triangle's corners, a cell's size.
class Tuple : public Value, public Container {
  public:
    static constexpr std::size_t kMost = 3;
    enum class Items { Coordinate, Index };

    /// `what` is for people: "a vertex: three numbers [x, y, z]".
    Tuple(std::size_t size, Items items, std::string_view what)
        : size_(size), what_(what), item_(*this, items) {}

    Container* array(Reader& reader) override;
    Value* element(Reader& reader) override;
    void close(Reader& reader) override;

    /// The numbers; an Index is held exactly. Those at fault are zero.
    const std::array<double, kMost>& numbers() const { return numbers_; }

  protected:
    std::string_view expected() const override { return what_; }
    /// All its numbers have been read, with faults or without.
    virtual void complete(Reader&) {}

  private:
    class Item : public Value {
      public:
        Item(Tuple& tuple, Items items) : tuple_(tuple), items_(items) {}
        void scalar(Reader& reader, const Scalar& value) override;

      protected:
        std::string_view expected() const override;

      private:
        Tuple& tuple_;
        Items items_;
    };

    std::size_t size_;
    std::string_view what_;
    std::size_t count_ = 0;
    std::array<double, kMost> numbers_{};
    Item item_;
};

/// An array of tuples, up to a limit.
template <std::size_t Size>
class TupleList : public Value, public Container {
  public:
    TupleList(std::string_view item, std::string_view list, std::size_t most)
        : item_(item, *this), list_(list), most_(most) {}

    Container* array(Reader&) override { return this; }
    Value* element(Reader& reader) override {
        if (items_.size() < most_) return &item_;
        reader.stop(FaultKind::TooLarge,
                    {"TOO_MANY_POINTS",
                     "More than " + std::to_string(most_) + " points; no more are taken.",
                     reader.pointer()});
        return nullptr;
    }
    const std::vector<std::array<double, Tuple::kMost>>& items() const { return items_; }

  protected:
    std::string_view expected() const override { return list_; }

  private:
    struct Item : Tuple {
        Item(std::string_view what, TupleList& the_list)
            : Tuple(Size, Items::Coordinate, what), list(the_list) {}
        void complete(Reader&) override { list.items_.push_back(numbers()); }
        TupleList& list;
    };

    Item item_;
    std::string_view list_;
    std::size_t most_;
    std::vector<std::array<double, Tuple::kMost>> items_;
};

/// A number as large as a coordinate may be.
class Number : public Value {
  public:
    void scalar(Reader& reader, const Scalar& value) override;
    double number() const { return number_; }

  protected:
    std::string_view expected() const override { return "a number"; }

  private:
    double number_ = 0.0;
};

/// Whether a coordinate can be worked with; if not, what to tell.
bool acceptable_coordinate(double value);
std::string coordinate_out_of_range();

}  // namespace tinsmith::api::json
