// Smooths the stair-stepped edges of a finished picture, after the idea of [Lottes09]: along an edge, colours are moved
// towards the other side by as much of the pixel as the edge, drawn straight between its two ends, would cover.
// On the processor: its own renderer takes both ways of every branch, so that the same pass as a shader costs 70 ms at
// 1280 x 720, and four samples a pixel three times the time of the whole picture.
#pragma once

#include <cstdint>
#include <vector>

namespace impinge {

/// RGBA, 8 bits, rows without gaps. The same bytes for any number of threads.
void smooth_edges(const std::vector<std::uint8_t>& in, std::vector<std::uint8_t>& out, int width, int height);

}  // namespace impinge
