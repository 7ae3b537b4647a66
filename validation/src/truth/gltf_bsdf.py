"""glTF's metallic-roughness reflection (glTF 2.0, appendix B) as a material of Mitsuba: GGX with height-correlated Smith
shadowing over a Lambertian base, mixed by Schlick's Fresnel at the half vector. Of the base's light a fraction may leave on the other
side (KHR_materials_diffuse_transmission).

To be imported after the variant is set.
"""

import drjit as dr
import mitsuba as mi

# Reflectance of a dielectric of index 1.5 at normal incidence.
DIELECTRIC = 0.04
# The sharpest lobe.
MIN_ALPHA = 1.0e-3


class Gltf(mi.BSDF):
    def __init__(self, properties):
        super().__init__(properties)
        self.base = properties.get_texture("base")
        self.roughness = properties.get_texture("roughness")
        self.metallic = properties.get_texture("metallic")
        # Fraction of the base's light that leaves on the other side, and its color.
        self.part = properties.get("part", 0.0)
        self.through = properties.get_texture("through")
        both = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        components = [mi.BSDFFlags.DiffuseReflection | both, mi.BSDFFlags.GlossyReflection | both]
        flags = components[0] | components[1]
        if self.part > 0.0:
            components.append(mi.BSDFFlags.DiffuseTransmission | both)
            flags |= components[2]
        self.m_components = components
        self.m_flags = flags

    def look(self, si, active):
        base = self.base.eval(si, active)
        metallic = self.metallic.eval_1(si, active)
        roughness = self.roughness.eval_1(si, active)
        alpha = dr.maximum(roughness * roughness, MIN_ALPHA)
        normal = DIELECTRIC * (1.0 - metallic) + base * metallic
        # Half of the samples to each lobe of a dielectric; a metal has one.
        chance = dr.select(metallic > 0.99, 1.0, 0.5)
        return base * ((1.0 - metallic) * (1.0 - self.part)), normal, alpha, chance

    @staticmethod
    def faced(si, wo):
        """Both directions on the side of the normal."""
        side = dr.select(mi.Frame3f.cos_theta(si.wi) < 0.0, -1.0, 1.0)
        return si.wi * mi.Vector3f(1, 1, side), wo * mi.Vector3f(1, 1, side), side

    def behind(self, wi, wo, si, active):
        """Value and density of light from behind, as the base of a medium of index 1 has it on the other side."""
        cosine = dr.maximum(-mi.Frame3f.cos_theta(wo), 0.0)
        rest = 1.0 - dr.clip(dr.dot(-wi, dr.normalize(wo - wi)), 0.0, 1.0)
        enters = 1.0 - (rest * rest) * (rest * rest) * rest
        value = self.through.eval(si, active) * (self.part * dr.inv_pi * enters * cosine)
        return value, dr.inv_pi * cosine

    def density(self, wi, wo, alpha, chance):
        half = dr.normalize(wi + wo)
        lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, True)
        glossy = lobe.pdf(wi, half) / (4.0 * dr.maximum(dr.dot(wi, half), 1.0e-6))
        diffuse = dr.inv_pi * dr.maximum(mi.Frame3f.cos_theta(wo), 0.0)
        return chance * glossy + (1.0 - chance) * (1.0 - self.part) * diffuse

    @staticmethod
    def value(wi, wo, diffuse, normal, alpha):
        half = dr.normalize(wi + wo)
        ci, co = mi.Frame3f.cos_theta(wi), mi.Frame3f.cos_theta(wo)
        ch, vh = mi.Frame3f.cos_theta(half), dr.clip(dr.dot(wi, half), 0.0, 1.0)
        a2 = alpha * alpha
        d = a2 / (dr.pi * dr.square(ch * ch * (a2 - 1.0) + 1.0))
        v = 0.5 / dr.maximum(
            co * dr.sqrt(ci * ci * (1.0 - a2) + a2) + ci * dr.sqrt(co * co * (1.0 - a2) + a2), 1.0e-9
        )
        rest = 1.0 - vh
        fresnel = normal + (1.0 - normal) * (rest * rest) * (rest * rest) * rest
        return ((1.0 - fresnel) * diffuse * dr.inv_pi + fresnel * (d * v)) * co

    def sample(self, context, si, sample_1, sample_2, active=True):
        wi, _, side = self.faced(si, mi.Vector3f(0, 0, 1))
        diffuse, normal, alpha, chance = self.look(si, active)
        lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, True)
        half, _ = lobe.sample(wi, sample_2)
        glossy = sample_1 < chance
        wo = dr.select(glossy, mi.reflect(wi, half), mi.warp.square_to_cosine_hemisphere(sample_2))
        passes = ~glossy & ((sample_1 - chance) / (1.0 - dr.minimum(chance, 0.999)) < self.part)
        wo = dr.select(passes, -wo, wo)
        active = active & (mi.Frame3f.cos_theta(wi) > 0.0) & (passes | (mi.Frame3f.cos_theta(wo) > 0.0))
        pdf = self.density(wi, wo, alpha, chance)
        value = self.value(wi, wo, diffuse, normal, alpha)
        if self.part > 0.0:
            other, density = self.behind(wi, wo, si, active)
            value = dr.select(passes, other, value)
            pdf = dr.select(passes, density * (1.0 - chance) * self.part, pdf)
        active &= pdf > 0.0
        found = mi.BSDFSample3f()
        found.wo = wo * mi.Vector3f(1, 1, side)
        found.pdf = dr.select(active, pdf, 0.0)
        found.eta = 1.0
        found.sampled_type = dr.select(
            glossy, mi.UInt32(+mi.BSDFFlags.GlossyReflection), mi.UInt32(+mi.BSDFFlags.DiffuseReflection)
        )
        found.sampled_component = dr.select(glossy, mi.UInt32(1), mi.UInt32(0))
        if self.part > 0.0:
            found.sampled_type = dr.select(passes, mi.UInt32(+mi.BSDFFlags.DiffuseTransmission), found.sampled_type)
            found.sampled_component = dr.select(passes, mi.UInt32(2), found.sampled_component)
        return found, dr.select(active, mi.Spectrum(value / pdf), 0.0)

    def eval(self, context, si, wo, active=True):
        wi, out, _ = self.faced(si, wo)
        diffuse, normal, alpha, _ = self.look(si, active)
        above = mi.Frame3f.cos_theta(out) > 0.0
        active = active & (mi.Frame3f.cos_theta(wi) > 0.0)
        value = dr.select(active & above, mi.Spectrum(self.value(wi, out, diffuse, normal, alpha)), 0.0)
        if self.part > 0.0:
            other, _ = self.behind(wi, out, si, active)
            value = dr.select(active & ~above, mi.Spectrum(other), value)
        return value

    def pdf(self, context, si, wo, active=True):
        wi, out, _ = self.faced(si, wo)
        _, _, alpha, chance = self.look(si, active)
        above = mi.Frame3f.cos_theta(out) > 0.0
        active = active & (mi.Frame3f.cos_theta(wi) > 0.0)
        density = dr.select(active & above, self.density(wi, out, alpha, chance), 0.0)
        if self.part > 0.0:
            _, other = self.behind(wi, out, si, active)
            density = dr.select(active & ~above, other * (1.0 - chance) * self.part, density)
        return density

    def eval_pdf(self, context, si, wo, active=True):
        return self.eval(context, si, wo, active), self.pdf(context, si, wo, active)

    def traverse(self, callback):
        pass

    def parameters_changed(self, keys):
        pass

    def to_string(self):
        return "Gltf[]"


mi.register_bsdf("gltf", lambda properties: Gltf(properties))
