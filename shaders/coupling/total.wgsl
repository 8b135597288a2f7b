// Sums over the grains at the lower faces of a cell, whichever kernel they are weighed by.

#define_import_path coupling::total
#ifdef WIDE
#import coupling::smooth::smoothed
#else
#import coupling::sums::at_faces
#endif

fn total(at: vec3<u32>) -> vec3<f32> {
#ifdef WIDE
    return smoothed(at, 0.0).faces;
#else
    return at_faces(at).xyz;
#endif
}
