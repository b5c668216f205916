# Generated from zerorate/regression.py by `make viper`: edit that file, not this one.
"""Sums of a weighted straight-line fit of orientation against the turns of a bias.

US 10,451,438: "performing a linear fit of the orientation ... as the function of time". A bias b
moves the orientation by M(t) b, M the integral of the rotation matrix; where the device keeps its
attitude on average that is a straight line in time. Two tilts come from the accelerometer's
gravity in the level frame, the heading from the turn about it. The window is tapered by
(1 - t^2)^2, so that unfinished cycles at its ends count little; what remains at the neighbouring
shapes 7 t^2 - 1 and 3 t^3 - t (orthogonal under that taper) measures the noise the slope has.

Sums of one component, 21 words: 6 of M M', 3 of M y, 3 of M, 1 of y, 3 + 3 of M and 1 + 1 of y
with the two shapes."""

import micropython


@micropython.viper
def centre(s: ptr32, row: int, shift: int, a: int):
    s_a = ptr32(int(s) + (a << 2))
    s_shift = ptr32(int(s) + (shift << 2))
    mean_total = s_a[12]
    mean_result = (mean_total << 8) // (s[18] >> 2)
    s_a[12] = mean_result
    row = row + 214
    mean_total = s_a[9]
    mean_result = (mean_total << 8) // (s[18] >> 2)
    s[203] = mean_result
    s[row] = s[row] - (s[203] << shift)
    mean_total = s_a[10]
    mean_result = (mean_total << 8) // (s[18] >> 2)
    s[204] = mean_result
    s[row + 1] = s[row + 1] - (s[204] << shift)
    mean_total = s_a[11]
    mean_result = (mean_total << 8) // (s[18] >> 2)
    s[205] = mean_result
    s[row + 2] = s[row + 2] - (s[205] << shift)
    row = a
    s[206] = s_a[12]
    shift = a + 9
    s_shift = ptr32(int(s) + (shift << 2))
    refer_d = shift - 3
    refer_mean = s[206]
    refer_scaled_a = s_shift[0] << 5
    refer_scaled_b = refer_mean
    refer_scaled_high = refer_scaled_b >> 15
    refer_scaled_b = refer_scaled_b & 32767
    refer_scaled_middle = (refer_scaled_a >> 15) * refer_scaled_b + (refer_scaled_a & 32767) * refer_scaled_high + ((refer_scaled_a & 32767) * refer_scaled_b >> 15)
    refer_scaled_high = (refer_scaled_a >> 15) * refer_scaled_high
    refer_taken = (refer_scaled_high << 15) + (refer_scaled_middle >> 0)
    s[refer_d] = s[refer_d] - refer_taken
    centre_row_h = row
    centre_row_refer_mean = s[203]
    centre_row_refer_scaled_a = s_shift[0] << 5
    centre_row_refer_scaled_b = centre_row_refer_mean
    centre_row_refer_scaled_high = centre_row_refer_scaled_b >> 15
    centre_row_refer_scaled_b = centre_row_refer_scaled_b & 32767
    centre_row_refer_scaled_middle = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_b + (centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_high + ((centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_b >> 15)
    centre_row_refer_scaled_high = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_high
    centre_row_refer_taken = (centre_row_refer_scaled_high << 15) + (centre_row_refer_scaled_middle >> 0)
    s[centre_row_h] = s[centre_row_h] - centre_row_refer_taken
    centre_row_h = centre_row_h + 1
    centre_row_refer_mean = s[204]
    centre_row_refer_scaled_a = s_shift[0] << 5
    centre_row_refer_scaled_b = centre_row_refer_mean
    centre_row_refer_scaled_high = centre_row_refer_scaled_b >> 15
    centre_row_refer_scaled_b = centre_row_refer_scaled_b & 32767
    centre_row_refer_scaled_middle = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_b + (centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_high + ((centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_b >> 15)
    centre_row_refer_scaled_high = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_high
    centre_row_refer_taken = (centre_row_refer_scaled_high << 15) + (centre_row_refer_scaled_middle >> 0)
    s[centre_row_h] = s[centre_row_h] - centre_row_refer_taken
    centre_row_h = centre_row_h + 1
    centre_row_refer_mean = s[205]
    centre_row_refer_scaled_a = s_shift[0] << 5
    centre_row_refer_scaled_b = centre_row_refer_mean
    centre_row_refer_scaled_high = centre_row_refer_scaled_b >> 15
    centre_row_refer_scaled_b = centre_row_refer_scaled_b & 32767
    centre_row_refer_scaled_middle = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_b + (centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_high + ((centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_b >> 15)
    centre_row_refer_scaled_high = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_high
    centre_row_refer_taken = (centre_row_refer_scaled_high << 15) + (centre_row_refer_scaled_middle >> 0)
    s[centre_row_h] = s[centre_row_h] - centre_row_refer_taken
    centre_row_h = centre_row_h + 1
    row = centre_row_h
    shift = a + 10
    s_shift = ptr32(int(s) + (shift << 2))
    refer_d = shift - 3
    refer_mean = s[206]
    refer_scaled_a = s_shift[0] << 5
    refer_scaled_b = refer_mean
    refer_scaled_high = refer_scaled_b >> 15
    refer_scaled_b = refer_scaled_b & 32767
    refer_scaled_middle = (refer_scaled_a >> 15) * refer_scaled_b + (refer_scaled_a & 32767) * refer_scaled_high + ((refer_scaled_a & 32767) * refer_scaled_b >> 15)
    refer_scaled_high = (refer_scaled_a >> 15) * refer_scaled_high
    refer_taken = (refer_scaled_high << 15) + (refer_scaled_middle >> 0)
    s[refer_d] = s[refer_d] - refer_taken
    centre_row_h = row
    centre_row_refer_mean = s[204]
    centre_row_refer_scaled_a = s_shift[0] << 5
    centre_row_refer_scaled_b = centre_row_refer_mean
    centre_row_refer_scaled_high = centre_row_refer_scaled_b >> 15
    centre_row_refer_scaled_b = centre_row_refer_scaled_b & 32767
    centre_row_refer_scaled_middle = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_b + (centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_high + ((centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_b >> 15)
    centre_row_refer_scaled_high = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_high
    centre_row_refer_taken = (centre_row_refer_scaled_high << 15) + (centre_row_refer_scaled_middle >> 0)
    s[centre_row_h] = s[centre_row_h] - centre_row_refer_taken
    centre_row_h = centre_row_h + 1
    centre_row_refer_mean = s[205]
    centre_row_refer_scaled_a = s_shift[0] << 5
    centre_row_refer_scaled_b = centre_row_refer_mean
    centre_row_refer_scaled_high = centre_row_refer_scaled_b >> 15
    centre_row_refer_scaled_b = centre_row_refer_scaled_b & 32767
    centre_row_refer_scaled_middle = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_b + (centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_high + ((centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_b >> 15)
    centre_row_refer_scaled_high = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_high
    centre_row_refer_taken = (centre_row_refer_scaled_high << 15) + (centre_row_refer_scaled_middle >> 0)
    s[centre_row_h] = s[centre_row_h] - centre_row_refer_taken
    centre_row_h = centre_row_h + 1
    row = centre_row_h
    shift = a + 11
    s_shift = ptr32(int(s) + (shift << 2))
    refer_d = shift - 3
    refer_mean = s[206]
    refer_scaled_a = s_shift[0] << 5
    refer_scaled_b = refer_mean
    refer_scaled_high = refer_scaled_b >> 15
    refer_scaled_b = refer_scaled_b & 32767
    refer_scaled_middle = (refer_scaled_a >> 15) * refer_scaled_b + (refer_scaled_a & 32767) * refer_scaled_high + ((refer_scaled_a & 32767) * refer_scaled_b >> 15)
    refer_scaled_high = (refer_scaled_a >> 15) * refer_scaled_high
    refer_taken = (refer_scaled_high << 15) + (refer_scaled_middle >> 0)
    s[refer_d] = s[refer_d] - refer_taken
    centre_row_h = row
    centre_row_refer_mean = s[205]
    centre_row_refer_scaled_a = s_shift[0] << 5
    centre_row_refer_scaled_b = centre_row_refer_mean
    centre_row_refer_scaled_high = centre_row_refer_scaled_b >> 15
    centre_row_refer_scaled_b = centre_row_refer_scaled_b & 32767
    centre_row_refer_scaled_middle = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_b + (centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_high + ((centre_row_refer_scaled_a & 32767) * centre_row_refer_scaled_b >> 15)
    centre_row_refer_scaled_high = (centre_row_refer_scaled_a >> 15) * centre_row_refer_scaled_high
    centre_row_refer_taken = (centre_row_refer_scaled_high << 15) + (centre_row_refer_scaled_middle >> 0)
    s[centre_row_h] = s[centre_row_h] - centre_row_refer_taken
    centre_row_h = centre_row_h + 1
    row = centre_row_h
