"""glTF's metallic-roughness reflection (glTF 2.0, appendix B) as a material of Mitsuba: GGX with height-correlated Smith
shadowing over a Lambertian base, mixed by Schlick's Fresnel at the half vector.

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
        both = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [mi.BSDFFlags.DiffuseReflection | both, mi.BSDFFlags.GlossyReflection | both]
        self.m_flags = self.m_components[0] | self.m_components[1]

    def look(self, si, active):
        base = self.base.eval(si, active)
        metallic = self.metallic.eval_1(si, active)
        roughness = self.roughness.eval_1(si, active)
        alpha = dr.maximum(roughness * roughness, MIN_ALPHA)
        normal = DIELECTRIC * (1.0 - metallic) + base * metallic
        # Half of the samples to each lobe of a dielectric; a metal has one.
        chance = dr.select(metallic > 0.99, 1.0, 0.5)
        return base * (1.0 - metallic), normal, alpha, chance

    @staticmethod
    def faced(si, wo):
        """Both directions on the side of the normal."""
        side = dr.select(mi.Frame3f.cos_theta(si.wi) < 0.0, -1.0, 1.0)
        return si.wi * mi.Vector3f(1, 1, side), wo * mi.Vector3f(1, 1, side), side

    @staticmethod
    def density(wi, wo, alpha, chance):
        half = dr.normalize(wi + wo)
        lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, True)
        glossy = lobe.pdf(wi, half) / (4.0 * dr.maximum(dr.dot(wi, half), 1.0e-6))
        diffuse = dr.inv_pi * dr.maximum(mi.Frame3f.cos_theta(wo), 0.0)
        return chance * glossy + (1.0 - chance) * diffuse

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
        active = active & (mi.Frame3f.cos_theta(wi) > 0.0) & (mi.Frame3f.cos_theta(wo) > 0.0)
        pdf = self.density(wi, wo, alpha, chance)
        active &= pdf > 0.0
        found = mi.BSDFSample3f()
        found.wo = wo * mi.Vector3f(1, 1, side)
        found.pdf = dr.select(active, pdf, 0.0)
        found.eta = 1.0
        found.sampled_type = dr.select(
            glossy, mi.UInt32(+mi.BSDFFlags.GlossyReflection), mi.UInt32(+mi.BSDFFlags.DiffuseReflection)
        )
        found.sampled_component = dr.select(glossy, mi.UInt32(1), mi.UInt32(0))
        value = self.value(wi, wo, diffuse, normal, alpha) / pdf
        return found, dr.select(active, mi.Spectrum(value), 0.0)

    def eval(self, context, si, wo, active=True):
        wi, out, _ = self.faced(si, wo)
        diffuse, normal, alpha, _ = self.look(si, active)
        active = active & (mi.Frame3f.cos_theta(wi) > 0.0) & (mi.Frame3f.cos_theta(out) > 0.0)
        return dr.select(active, mi.Spectrum(self.value(wi, out, diffuse, normal, alpha)), 0.0)

    def pdf(self, context, si, wo, active=True):
        wi, out, _ = self.faced(si, wo)
        _, _, alpha, chance = self.look(si, active)
        active = active & (mi.Frame3f.cos_theta(wi) > 0.0) & (mi.Frame3f.cos_theta(out) > 0.0)
        return dr.select(active, self.density(wi, out, alpha, chance), 0.0)

    def eval_pdf(self, context, si, wo, active=True):
        return self.eval(context, si, wo, active), self.pdf(context, si, wo, active)

    def traverse(self, callback):
        pass

    def parameters_changed(self, keys):
        pass

    def to_string(self):
        return "Gltf[]"


mi.register_bsdf("gltf", lambda properties: Gltf(properties))
