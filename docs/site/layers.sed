# What a header declares belongs to the group of its layer, which no header can forget so: the group is
# opened and closed where its namespace is.
s@^namespace (OpenSubdivHex::)?FarExt \{$@& /** \\addtogroup far_ext */ /** \\{ */@
s@^namespace (OpenSubdivHex::)?OsdExt \{$@& /** \\addtogroup osd_ext */ /** \\{ */@
s@^namespace (OpenSubdivHex::)?BfrExt \{$@& /** \\addtogroup bfr_ext */ /** \\{ */@
s@^\} // namespace (OpenSubdivHex::)?(Far|Osd|Bfr)Ext$@/** \\} */ &@
