#include "viewer/image/label.hpp"

#include <algorithm>

namespace impinge {

namespace {

// ' ' to '_', then '{' to '~'; one row of five pixels a hexadecimal pair, top row first, the leftmost pixel in bit 4
constexpr std::string_view kGlyphs[] = {
    "00000000000000",                                                                          // space
    "04040404040004", "0A0A0A00000000", "0A0A1F0A1F0A0A", "040F140E051E04", "18190204081303",  // ! " # $ %
    "0C12140815120D", "04040800000000", "02040808080402", "08040202020408", "00041F0E1F0400",  // & ' ( ) *  (star)
    "0004041F040400", "00000000060408", "0000001F000000", "00000000000C0C", "00010204081000",  // + , - . /
    "0E11131519110E", "040C040404040E", "0E11010204081F", "1F02040201110E", "02060A121F0202",  // 0 1 2 3 4
    "1F101E0101110E", "0608101E11110E", "1F010204080808", "0E11110E11110E", "0E11110F01020C",  // 5 6 7 8 9
    "000C0C000C0C00", "000C0C000C0408", "02040810080402", "00001F001F0000", "08040201020408",  // : ; < = >
    "0E110102040004", "0E11171517100E",                                                        // ? @
    "0E11111F111111", "1E11111E11111E", "0E11101010110E", "1C12111111121C", "1F10101E10101F",  // A B C D E
    "1F10101E101010", "0E11101711110F", "1111111F111111", "0E04040404040E", "0702020202120C",  // F G H I J
    "11121418141211", "1010101010101F", "111B1515111111", "11111915131111", "0E11111111110E",  // K L M N O
    "1E11111E101010", "0E11111115120D", "1E11111E141211", "0F10100E01011E", "1F040404040404",  // P Q R S T
    "1111111111110E", "11111111110A04", "11111115151B11", "11110A040A1111", "11110A04040404",  // U V W X Y
    "1F01020408101F", "0E08080808080E", "00100804020100", "0E02020202020E", "040A1100000000",  // Z [ \ ] ^
    "0000000000001F",                                                                          // _
    "02040408040402", "04040404040404", "08040402040408", "00000815020000",                    // { | } ~
};
constexpr std::string_view kBox = "1F11111111111F";

std::string_view glyph(char c) {
  if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  if (c == '`') c = '\'';
  if (c >= ' ' && c <= '_') return kGlyphs[c - ' '];
  if (c >= '{' && c <= '~') return kGlyphs[c - '{' + ('_' - ' ' + 1)];
  return kBox;
}

int digit(char c) { return c <= '9' ? c - '0' : c - 'A' + 10; }

}  // namespace

int text_width(std::string_view text, int scale) {
  return text.empty() ? 0 : (6 * static_cast<int>(text.size()) - 1) * scale;
}

void draw_text(Image& image, int x, int y, std::string_view text, Rgb colour, int scale) {
  for (const char c : text) {
    const std::string_view rows = glyph(c);
    for (int row = 0; row < 7; ++row) {
      const int bits = 16 * digit(rows[2 * row]) + digit(rows[2 * row + 1]);
      for (int column = 0; column < 5; ++column)
        if (bits >> (4 - column) & 1) fill_rectangle(image, x + column * scale, y + row * scale, scale, scale, colour);
    }
    x += 6 * scale;
  }
}

void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour) {
  const int x_end = std::min(x + width, image.width), y_end = std::min(y + height, image.height);
  for (int row = std::max(y, 0); row < y_end; ++row)
    for (int column = std::max(x, 0); column < x_end; ++column)
      std::copy(colour.begin(), colour.end(), image.pixel(column, row));
}

void draw_rectangle(Image& image, int x, int y, int width, int height, int thickness, Rgb colour) {
  const int t = std::min({thickness, width, height});
  fill_rectangle(image, x, y, width, t, colour);
  fill_rectangle(image, x, y + height - t, width, t, colour);
  fill_rectangle(image, x, y, t, height, colour);
  fill_rectangle(image, x + width - t, y, t, height, colour);
}

}  // namespace impinge
