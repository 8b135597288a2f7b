// What resists the water. Twin of coupling/src/drag, which has the formulas, their range and sources.
//
//   (none)     Darcy's law, the permeability is flow_a [m^2]
//   POROSITY   Darcy's law, flow_a times phi^3/(1 - phi)^2
//   ERGUN      Ergun's law, the diameter is flow_a [m]
//   DI_FELICE  Di Felice's law, the same
//
// The permeability of Darcy's law lies within flow_b and flow_c.

#define_import_path coupling::resistance
#import coupling::numbers::numbers

// R [Pa s/m^2] at a porosity and a flux [m/s].
fn resistance(porosity: f32, flux: f32) -> f32 {
    let solid = 1.0 - porosity;
#ifdef ERGUN
    let cube = porosity * porosity * porosity * numbers.flow_a;
    let viscous = 150.0 * numbers.viscosity * solid * solid / (cube * numbers.flow_a);
    return viscous + 1.75 * numbers.density * solid * flux / cube;
#else
#ifdef DI_FELICE
    let d = numbers.flow_a;
    let reynolds = numbers.density * flux * d / numbers.viscosity;
    var exponent = 3.7;
    if reynolds > 0.0 {
        let away = 1.5 - 0.4342944819032518 * log(reynolds);
        exponent -= 0.65 * exp(-0.5 * away * away);
    }
    let root = 0.63 * sqrt(flux) + 4.8 * sqrt(numbers.viscosity / (numbers.density * d));
    let drag = 0.75 * numbers.density * root * root / d;
    return solid * drag * pow(porosity, -exponent) / porosity;
#else
    var k = numbers.flow_a;
#ifdef POROSITY
    k *= porosity * porosity * porosity / (solid * solid);
#endif
    return numbers.viscosity / clamp(k, numbers.flow_b, numbers.flow_c);
#endif
#endif
}
